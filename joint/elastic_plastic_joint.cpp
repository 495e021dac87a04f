#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "structure.h"

namespace ductile {

using namespace dynamics;

void ElasticPlasticJointDef::Initialize(b2Body* a, b2Body* b, const b2Vec2& anchor) {
  const b2Vec2 to_anchor = anchor - a->GetWorldCenter();
  Initialize(a, b, anchor, to_anchor.LengthSquared() > 0 ? to_anchor : a->GetWorldVector({1, 0}));
}

void ElasticPlasticJointDef::Initialize(b2Body* a, b2Body* b, const b2Vec2& anchor, const b2Vec2& axis) {
  bodyA = a;
  bodyB = b;
  localAnchorA = a->GetLocalPoint(anchor);
  localAnchorB = b->GetLocalPoint(anchor);
  referenceAngle = b->GetAngle() - a->GetAngle();
  axisAngle = b2Atan2(axis.y, axis.x) - a->GetAngle();
}

void ElasticPlasticJointDef::InitializeLine(b2Body* a, b2Body* b, const b2Vec2& anchor_a,
                                            const b2Vec2& anchor_b) {
  const b2Vec2 along = anchor_b - anchor_a;
  Initialize(a, b, anchor_a, along.LengthSquared() > 0 ? along : a->GetWorldVector({1, 0}));
  localAnchorB = b->GetLocalPoint(anchor_b);
  line = true;
  rows[shear] = rows[rotation] = RowDef::free();
}

namespace {

constexpr const char* row_names[] = {"axial", "shear", "rotation"};

// Of one row, each a clause.
std::vector<std::string> wrong_in(const RowDef& row) {
  std::vector<std::string> wrong;
  const auto require = [&](bool good, const char* text) {
    if (!good) wrong.emplace_back(text);
  };
  if (!(row.stiffness > 0))
    wrong.push_back("stiffness is " + std::to_string(row.stiffness) + "; must be > 0 (or rigid)");
  require(row.damping_ratio >= 0 && std::isfinite(row.damping_ratio), "damping_ratio must be ≥ 0 and finite");
  require(row.damping >= 0 && std::isfinite(row.damping), "damping must be ≥ 0 and finite");
  require(row.cap >= 0 && row.cap_reverse >= 0, "caps must be ≥ 0 (0: free, unlimited: never yields)");
  require(row.hardening >= 0 && row.hardening < row.stiffness, "hardening must be in [0, stiffness)");
  require(!row.slackens || !(row.cap > 0 && row.cap_reverse > 0), "a row that slackens has a cap of 0");
  require(!row.drive ||
              (row.drive->speed >= 0 && std::isfinite(row.drive->speed) && !std::isnan(row.drive->target)),
          "a drive's speed must be ≥ 0 and finite, its target a number");
  require(!row.drive || !(row.hardening > 0), "a driven row does not harden; set hardening to 0");
  return wrong;
}

bool carries_nothing(const RowDef& row) { return row.cap == 0 && row.cap_reverse == 0; }
constexpr const char* line_rule =
    "a line carries along its axis only; set the shear and rotation rows free()";
constexpr const char* surface_rule = "an interaction curve takes no drive and does not slacken";

}  // namespace

std::vector<std::string> wrong_in(const ElasticPlasticJointDef& def) {
  std::vector<std::string> wrong;
  const auto require = [&](bool good, const std::string& text) {
    if (!good) wrong.push_back("elastic-plastic joint: " + text);
  };
  require(def.bodyA != nullptr && def.bodyB != nullptr, "bodyA and bodyB must be set; call Initialize");
  require(def.bodyA != def.bodyB || def.bodyA == nullptr,
          "joins a body with itself; bodyA and bodyB must differ");
  require(def.localAnchorA.IsValid() && def.localAnchorB.IsValid() && std::isfinite(def.axisAngle) &&
              std::isfinite(def.referenceAngle),
          "anchors and angles must be finite");
  require(def.axisFollow >= 0 && def.axisFollow <= 1, "axisFollow must be within [0, 1]");
  for (unsigned i = 0; i < 3; ++i) {
    for (const std::string& text : wrong_in(def.rows[i]))
      require(false, std::string(row_names[i]) + " row: " + text);
  }
  require(!def.line || (carries_nothing(def.rows[shear]) && carries_nothing(def.rows[rotation])), line_rule);
  require(!std::isnan(def.length) && !std::isinf(def.length), "length must be finite (below 0: as it is)");
  for (const double limit : {def.max_rotation, def.max_elongation, def.max_compression, def.max_slip}) {
    require(limit >= 0, "maxima must be ≥ 0 (unlimited: never breaks by it)");
  }
  if (def.rate) {
    for (const double d : def.rate->doubling) require(d > 0, "a rate at which a cap is doubled must be > 0");
    require(def.rate->exponent >= 1 && std::isfinite(def.rate->exponent),
            "a rate law's exponent must be ≥ 1 and finite");
    require(def.interaction.empty(), "an interaction curve takes no rate law; use independent caps");
    for (const RowDef& row : def.rows)
      require(!(row.hardening > 0) && !row.slackens && !row.drive,
              "a joint with a rate law does not harden, slacken or drive");
  }
  for (std::string& text : wrong_in(def.state)) wrong.push_back(std::move(text));
  if (!def.interaction.empty()) {
    for (const RowDef& row : def.rows) {
      require(!(row.hardening > 0), "an interaction curve does not harden; set hardening to 0");
      require(!row.slackens && !row.drive, surface_rule);
    }
    try {
      YieldSurface(def.interaction, def.rows[shear].cap);
    } catch (const std::invalid_argument& error) {
      require(false, error.what());
    }
  }
  return wrong;
}

ElasticPlasticJoint* ElasticPlasticJoint::cast(b2Joint* joint) {
  return dynamic_cast<ElasticPlasticJoint*>(joint);
}

namespace {
const Joint none{};
const JointRecord no_record{};
}  // namespace

const Joint& ElasticPlasticJoint::row_state() const { return member_ != nullptr ? member_->data() : none; }
const JointRecord& ElasticPlasticJoint::record() const {
  return member_ != nullptr ? member_->record() : no_record;
}

std::uint32_t ElasticPlasticJoint::id() const { return member_ != nullptr ? member_->id : UINT32_MAX; }

b2Vec2 ElasticPlasticJoint::axis() const {
  const Joint& j = row_state();
  if (b2Vec2 along = GetAnchorB() - GetAnchorA(); j.frame.line && along.Normalize() > 0) return along;
  const double relative = double{m_bodyB->GetAngle()} - double{m_bodyA->GetAngle()} - j.frame.reference;
  const double angle =
      m_bodyA->GetAngle() + std::atan2(j.frame.axis.s, j.frame.axis.c) + j.frame.follow * relative;
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

double ElasticPlasticJoint::force(Row row) const { return dynamics::force(row_state(), record())[row]; }

double ElasticPlasticJoint::cap(Row row, bool reverse) const {
  return (reverse ? record().material.cap_reverse : record().material.cap)[row];
}

double ElasticPlasticJoint::usage(Row row) const {
  const double f = force(row), limit = cap(row, f < 0);
  if (std::isinf(limit)) return NAN;
  return limit > 0 ? std::abs(f) / limit : 0;
}

double ElasticPlasticJoint::elastic(Row row) const { return elastic_strain(row_state(), record(), row); }
double ElasticPlasticJoint::neutral(Row row) const { return row_state().neutral[row]; }
double ElasticPlasticJoint::plastic(Row row) const { return record().plastic.net[row]; }

double ElasticPlasticJoint::accumulated_rotation() const {
  return record().plastic.forward[rotation] + record().plastic.back[rotation];
}
double ElasticPlasticJoint::elongation() const { return record().plastic.forward[axial]; }
double ElasticPlasticJoint::compression() const { return record().plastic.back[axial]; }
double ElasticPlasticJoint::slip() const {
  return record().plastic.forward[shear] + record().plastic.back[shear];
}

double ElasticPlasticJoint::capacity_used() const {
  if (member_ == nullptr) return 0;
  return member_->limits.used(record().plastic);
}

double ElasticPlasticJoint::ductility() const {
  const JointRecord& r = record();
  const auto reach = [&](Row row, bool reverse) {
    if (r.material.surface == nullptr) return cap(row, reverse);
    if (row == shear) return r.material.surface->shear();
    double most = 0;  // the largest share of the surface that 1 N or 1 N m of the row alone uses
    for (const YieldSurface::Facet& f : r.material.surface->facets())
      most = std::max(most, (reverse ? -1 : 1) * (row == axial ? f.n : f.m));
    return 1 / most;
  };
  double largest = 0;
  for (const Row row : {axial, shear, rotation}) {
    const double k = r.material.stiffness[row];
    double sum = 0;
    for (const bool reverse : {false, true}) {
      const double flowed = (reverse ? r.plastic.back : r.plastic.forward)[row];
      if (flowed > 0) sum += flowed / (std::isinf(k) ? 0 : reach(row, reverse) / k);
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

bool ElasticPlasticJoint::yielded() const { return member_ != nullptr && member_->said.yielded; }
bool ElasticPlasticJoint::broken() const { return member_ != nullptr && member_->broken; }

double ElasticPlasticJoint::dissipated() const {
  const Rows& d = record().dissipated;
  return std::max(0.0, d[0] + d[1] + d[2]);  // rows on a yield surface may cancel but for rounding
}

// What rings in a row that no step resolves is no strain that its force stands for.
double ElasticPlasticJoint::elastic_energy() const {
  const RowLaw& law = record().law;
  double sum = 0;
  for (const Row row : {axial, shear, rotation}) {
    if (!(law.spring[row] > 0)) continue;
    const double e = within(elastic(row), row_state().impulse[row] / (law.h * law.spring[row]));
    sum += law.spring[row] * e * e / 2;
  }
  return sum;
}

bool ElasticPlasticJoint::stiffness_limited(Row row) const {
  const JointRecord& r = record();
  const double k = r.material.stiffness[row], integrated = r.law.spring[row];
  return std::isfinite(k) && integrated > 0 && integrated < k;
}

// What an edited joint is, its def may be.
void ElasticPlasticJoint::require(Row row, const RowDef& to) const {
  const auto refuse = [](const std::string& text) {
    throw std::invalid_argument("elastic-plastic joint: " + text);
  };
  if (const auto wrong = wrong_in(to); !wrong.empty())
    refuse(std::string(row_names[row]) + " row: " + wrong.front());
  if (row_state().frame.line && row != axial && !carries_nothing(to)) refuse(line_rule);
  if (record().material.surface != nullptr && to.drive) refuse(surface_rule);
  if (record().material.rate != nullptr && to.drive) refuse("a joint with a rate law takes no drive");
}

void ElasticPlasticJoint::set_caps(Row row, double cap, double cap_reverse) {
  if (record().material.surface != nullptr)
    throw std::invalid_argument(
        "elastic-plastic joint: its caps are those of its interaction curve; make the joint anew");
  RowDef to = this->row(row);
  to.cap = cap;
  to.cap_reverse = cap_reverse;
  require(row, to);
  if (member_ == nullptr || member_->broken) return;
  member_->record().material.cap[row] = cap;
  member_->record().material.cap_reverse[row] = cap_reverse;
  wake();
}

void ElasticPlasticJoint::drive(Row row, const Drive& drive) {
  RowDef to = this->row(row);
  to.drive = drive;
  require(row, to);
  if (member_ == nullptr || member_->broken) return;
  member_->record().material.drive(row, drive.target, drive.speed);
  wake();
}

void ElasticPlasticJoint::set_stiffness(Row row, double stiffness, double damping_ratio) {
  RowDef to = this->row(row);
  to.stiffness = stiffness;
  to.damping_ratio = damping_ratio;
  require(row, to);
  if (member_ == nullptr) return;
  member_->record().material.stiffness[row] = stiffness;
  member_->record().material.damping_ratio[row] = damping_ratio;
  member_->record().material.damping[row] = 0;
  wake();
}

void ElasticPlasticJoint::set_limits(double max_rotation, double max_elongation, double max_compression,
                                     double max_slip) {
  if (!(max_rotation >= 0 && max_elongation >= 0 && max_compression >= 0 && max_slip >= 0)) {
    throw std::invalid_argument("elastic-plastic joint: maxima must be ≥ 0");
  }
  if (member_ == nullptr) return;
  member_->limits = {max_rotation, max_elongation, max_compression, max_slip};
}

void ElasticPlasticJoint::wake() {
  if (member_->component != nullptr) member_->component->disturb();
  m_bodyA->SetAwake(true);
  m_bodyB->SetAwake(true);
}

b2Vec2 ElasticPlasticJoint::GetReactionForce(float inv_dt) const {
  if (member_ == nullptr) return b2WeldJoint::GetReactionForce(inv_dt);
  const b2Vec2 t = axis(), n{-t.y, t.x};
  const Rows& s = row_state().impulse;
  return -inv_dt * (static_cast<float>(s[axial]) * t + static_cast<float>(s[shear]) * n);
}

float ElasticPlasticJoint::GetReactionTorque(float inv_dt) const {
  if (member_ == nullptr) return b2WeldJoint::GetReactionTorque(inv_dt);
  return -inv_dt * static_cast<float>(row_state().impulse[rotation]);
}

void ElasticPlasticJoint::ShiftOrigin(const b2Vec2& newOrigin) {
  if (member_ != nullptr) member_->structure->shift_origin(newOrigin, *member_);
}

}  // namespace ductile
