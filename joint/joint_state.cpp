// What a joint has been through, out of it and into it.
#include <cmath>
#include <stdexcept>

#include "structure.h"

namespace ductile {

using namespace dynamics;

std::vector<std::string> wrong_in(const JointState& state) {
  std::vector<std::string> wrong;
  for (unsigned i = 0; i < 3; ++i) {
    if (!std::isfinite(state.elastic[i]) || !std::isfinite(state.plastic[i]) ||
        !std::isfinite(state.dissipated[i]))
      wrong.emplace_back("elastic-plastic joint: elastic, plastic and dissipated of a state must be finite");
    if (!(state.forward[i] >= 0 && state.back[i] >= 0))
      wrong.emplace_back("elastic-plastic joint: forward and back of a state must be ≥ 0");
  }
  return wrong;
}

// A joint that was never solved has no gap yet: its neutral position is relative to where that will be.
void Member::set_state(const JointState& s) {
  Joint& j = data();
  JointRecord& r = record();
  for (unsigned i = 0; i < 3; ++i) {
    j.neutral[i] = (own.fresh ? 0 : r.gap[i]) - s.elastic[i];
    if (is_implicit(r, i)) j.impulse[i] = r.law.h * r.law.spring[i] * s.elastic[i];
    r.plastic.net[i] = s.plastic[i];
    r.plastic.forward[i] = s.forward[i];
    r.plastic.back[i] = s.back[i];
    r.dissipated[i] = s.dissipated[i];
  }
  if (!own.fresh) {
    StepLaws::set_equal_bias(j, r.gap);
    if (j.special) j.forget_rates();  // of what was slack they hold all of its way as strain
  }
  said = {s.yielded, joint->capacity_used(), joint->dissipated()};
}

JointState ElasticPlasticJoint::state() const {
  JointState s;
  if (member_ == nullptr) return s;
  const JointRecord& r = record();
  const Joint& j = row_state();
  for (unsigned i = 0; i < 3; ++i) {
    s.elastic[i] = elastic(static_cast<Row>(i));
    if (member_->own.fresh || j.special)
      s.elastic[i] = (member_->own.fresh ? 0 : r.gap[i]) - j.neutral[i];  // slack, too
    s.plastic[i] = r.plastic.net[i];
    s.forward[i] = r.plastic.forward[i];
    s.back[i] = r.plastic.back[i];
    s.dissipated[i] = r.dissipated[i];
  }
  s.yielded = member_->said.yielded;
  return s;
}

void ElasticPlasticJoint::set_state(const JointState& to) {
  if (const auto wrong = wrong_in(to); !wrong.empty()) throw std::invalid_argument(wrong.front());
  if (member_ == nullptr || member_->broken) return;
  const double before = dissipated();
  member_->set_state(to);
  member_->structure->gone.dissipated += before - dissipated();
  wake();
}

RowDef ElasticPlasticJoint::row(Row i) const {
  const Material& m = record().material;
  if (member_ == nullptr) return {};
  RowDef def{.stiffness = m.stiffness[i],
             .damping_ratio = m.damping_ratio[i],
             .cap = m.cap[i],
             .cap_reverse = m.cap_reverse[i],
             .hardening = m.hardening[i],
             .damping = m.damping[i],
             .slackens = m.may_slacken(i)};
  if (m.is_driven(i)) def.drive = Drive{m.target[i], m.speed[i]};
  return def;
}

ElasticPlasticJointDef ElasticPlasticJoint::def() const {
  ElasticPlasticJointDef d;
  d.bodyA = m_bodyA;
  d.bodyB = m_bodyB;
  d.userData = m_userData;
  d.collideConnected = m_collideConnected;
  d.localAnchorA = m_localAnchorA;
  d.localAnchorB = m_localAnchorB;
  d.referenceAngle = m_referenceAngle;
  const Frame& frame = row_state().frame;
  d.axisAngle = static_cast<float>(std::atan2(frame.axis.s, frame.axis.c));
  d.axisFollow = static_cast<float>(frame.follow);
  if (member_ == nullptr) return d;
  for (const Row i : {axial, shear, rotation}) d.rows[i] = row(i);
  d.line = frame.line;
  if (d.line) d.length = member_->own.fresh ? member_->length : row_state().neutral[axial];
  d.max_rotation = member_->limits.rotation;
  d.max_elongation = member_->limits.elongation;
  d.max_compression = member_->limits.compression;
  d.max_slip = member_->limits.slip;
  if (member_->surface != nullptr) {
    const auto polygon = member_->surface->polygon();
    d.interaction.assign(polygon.begin(), polygon.end());
    d.rows[shear].cap = d.rows[shear].cap_reverse = member_->surface->shear();
  }
  if (member_->rate != nullptr) d.rate = *member_->rate;
  d.break_group = member_->break_group;
  d.node = member_->node;
  d.state = state();
  return d;
}

}  // namespace ductile
