// The numbers of one joint: from its sections, materials and what the user says instead.
#pragma once

#include <array>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "ductile/calibrate.h"
#include "half.h"
#include "strip.h"

namespace ductile::calibration {

/// What a joint connects, seen from the joint.
struct Side {
  const std::string* body = nullptr;  ///< its name
  const Strip* strip = nullptr;       ///< null: no material, does not govern
  bool reversed = false;              ///< the joint's axis runs against the strip
  double reach = 0;  ///< m: ℓ of this side, half of the piece's extent along the axis; 0: it does not give
  bool straight = true;  ///< ℓ is along the axis
  Longer longer;         ///< than ℓ: what gives as much of the cut's section
  double inertia = 0;    ///< kg m² of the piece about its centre
};

/// Of the intervals in line along which two pieces touch.
struct Sharing {
  int intervals = 1;
  const char* how = nullptr;  ///< said of more than one: what they are, and why
  friend bool operator==(const Sharing&, const Sharing&) = default;
};

/// A user's word, and whose it is: "joint", "body", "scene".
struct Overriding {
  const char* name;
  const JointOverrides* values;
};

/// Works out joints: caps, stiffness, damping, limits and `governed_by`.
class Caps {
 public:
  /// Reasons go to `reasons`, each once; what cannot be, to `problems`.
  Caps(std::vector<std::string>& reasons, std::vector<Problem>& problems)
      : reasons_(reasons), problems_(problems) {}

  /// The number of a reason, new or not.
  int reason(const std::string& text);

  /// The joint has its height and intervals; the first of `overriding` that sets a value wins.
  void fill_in(PlannedJoint& joint, const std::array<Side, 2>& sides, std::span<const Overriding> overriding,
               const Sharing& sharing);

 private:
  // What a reason says. Most joints have that of the one before.
  struct Governed {
    std::array<int, 9> sources{};
    const char* stiffness = nullptr;
    std::array<const std::string*, 2> bodies{};
    const char* innermost = nullptr;
    Sharing sharing;
    const char* hinge = nullptr;  // who gave its length or shear span
    int hardening_side = -1;      // whose hardening it is made of
    friend bool operator==(const Governed&, const Governed&) = default;
  };
  static std::string text(const Governed& governed, std::span<const Overriding> overriding);

  std::vector<std::string>& reasons_;
  std::vector<Problem>& problems_;
  Governed last_;
  int last_reason_ = -1;
  std::unordered_map<std::string, int> numbers_;  // of the reasons
};

}  // namespace ductile::calibration
