#include "merge.h"

#include <algorithm>
#include <utility>

#include "ductile/plane.h"
#include "groups.h"

namespace ductile {
namespace {

// Pieces that move as one; those that stand still are all in the last group.
class Bodies {
 public:
  explicit Bodies(const Plan& plan) : groups_(plan.pieces.size() + 1), still_(plan.pieces.size()) {
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      const Piece& piece = plan.pieces[i];
      if (piece.part_of >= 0) unite(i, index(piece.part_of));
      if (piece.stands_still || plan.bodies[index(piece.body)].type == BodyType::static_body)
        unite(i, still_);
    }
  }
  std::size_t still() const { return still_; }
  std::size_t of(int piece) const { return groups_.of(piece < 0 ? still_ : index(piece)); }
  bool inside(const PlannedJoint& joint) const { return of(joint.a) == of(joint.b); }

  // False, and nothing done, where that would put one of `kept` inside a group.
  bool fuse(const PlannedJoint& joint, const std::vector<const PlannedJoint*>& kept) {
    const std::size_t a = of(joint.a), b = of(joint.b);
    const bool would = std::any_of(kept.begin(), kept.end(), [&](const PlannedJoint* k) {
      const std::size_t c = of(k->a), d = of(k->b);
      return (c == a && d == b) || (c == b && d == a);
    });
    if (would) return false;
    unite(a, b);
    return true;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  // The lower one leads, but for what stands still.
  void unite(std::size_t a, std::size_t b) {
    a = groups_.of(a);
    b = groups_.of(b);
    if (b == still_ || (b < a && a != still_)) std::swap(a, b);
    groups_.unite(a, b);
  }

  Groups groups_;
  std::size_t still_;
};

// Mass, inertia and centre of the leading piece become those of all.
void carry(Plan& plan, const std::vector<std::size_t>& parts) {
  Piece& lead = plan.pieces[parts.front()];
  double mass = 0;
  Point first;
  for (const std::size_t i : parts) {
    mass += plan.pieces[i].mass;
    first = first + plan.pieces[i].mass * plan.pieces[i].center;
  }
  const Point centre = (1 / mass) * first;
  double inertia = 0;
  for (const std::size_t i : parts) {
    const Point arm = plan.pieces[i].center - centre;
    inertia += plan.pieces[i].inertia + plan.pieces[i].mass * dot(arm, arm);
    plan.pieces[i].mass = plan.pieces[i].inertia = 0;
    plan.pieces[i].part_of = static_cast<int>(parts.front());
  }
  lead.part_of = -1;
  lead.mass = mass;
  lead.inertia = inertia;
  lead.center = centre;
}

}  // namespace

Plan merged(const Plan& plan, const std::vector<int>& fused) {
  std::vector<bool> is_fused(plan.joints.size());
  for (const int i : fused) is_fused[static_cast<std::size_t>(i)] = true;
  std::vector<const PlannedJoint*> kept;
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (!is_fused[i]) kept.push_back(&plan.joints[i]);
  Bodies bodies(plan);
  for (const int i : fused) bodies.fuse(plan.joints[static_cast<std::size_t>(i)], kept);

  Plan result = plan;
  std::vector<std::vector<std::size_t>> parts(plan.pieces.size());
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    if (!plan.is_dynamic(static_cast<int>(i))) continue;
    const std::size_t group = bodies.of(static_cast<int>(i));
    if (group != bodies.still()) {
      parts[group].push_back(i);
      continue;
    }
    Piece& piece = result.pieces[i];
    piece.stands_still = true;
    piece.part_of = -1;
    piece.mass = piece.inertia = 0;
  }
  for (const auto& group : parts)
    if (group.size() > 1) carry(result, group);
  std::erase_if(result.joints, [&](const PlannedJoint& joint) { return bodies.inside(joint); });
  return result;
}

}  // namespace ductile
