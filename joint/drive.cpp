#include "drive.h"

#include <algorithm>

namespace ductile::dynamics {

void list_special(System& system) {
  system.driven.clear();
  system.rated.clear();
  system.slackening.clear();
  for (std::size_t k = 0; k < system.own(); ++k) {
    const Material& m = system.records[k].material;
    system.joints[k].special = (m.slackens | m.driven) != 0;
    if (m.driven != 0) system.driven.push_back(static_cast<int>(k));
    if (m.rate != nullptr) system.rated.push_back(static_cast<int>(k));
    if (m.slackens != 0) system.slackening.push_back(static_cast<int>(k));
  }
}

void begin_drives(System& system, double h) {
  for (const int k : system.driven) {
    Joint& j = system.joints[z(k)];
    JointRecord& r = system.records[z(k)];
    for (unsigned i = 0; i < 3; ++i) {
      r.drive_rate[i] = 0;
      if (!is_driven(r, i) || !(j.G[i] > 0)) continue;
      const double left = (r.material.target[i] - j.neutral[i]) / h, speed = r.material.speed[i];
      r.drive_rate[i] = std::clamp(left, -speed, speed);
      j.bias[i] -= r.drive_rate[i];
    }
  }
}

void move_drive(Joint& j, const JointRecord& r, double h) {
  for (unsigned i = 0; i < 3; ++i) {
    j.bias[i] += r.drive_rate[i];
    j.neutral[i] += h * r.drive_rate[i];
  }
}

// p and u₋ alike, so that what they part by as they turn is half of their difference (flow.h).
void correct_rates(Joint& j, const JointRecord& r, const Rows& gap, double h) {
  for (unsigned i = 0; i < 3; ++i) {
    if (!j.is_newmark(i)) continue;
    if (is_slack(j, r, i)) {
      j.rate[i] = 2 * (gap[i] - j.neutral[i]) / h;
      j.moved[i] = h * j.rate[i];
    } else if (!flows(j.regime, i)) {
      j.rate[i] -= r.drive_rate[i];
      j.moved[i] -= h * r.drive_rate[i];
    }
  }
}

}  // namespace ductile::dynamics
