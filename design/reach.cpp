// What a scene as a whole shows, and what it takes to show more.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "ductile/plane.h"
#include "ductile/strip_line.h"
#include "ductile/targets.h"
#include "seek.h"

namespace ductile {
namespace {

// Beyond the critical load there is no state of second order.
bool has_buckled(const StaticCheck& check) {
  return std::all_of(check.turn.begin(), check.turn.end(), [](double turn) { return std::isnan(turn); });
}

// Of a disc, its centre's and what it turns at its rim, at most.
double largest_displacement(const Plan& plan, Order order) {
  const StaticCheck check = static_check(plan, order);
  if (has_buckled(check)) return unlimited;
  double most = 0;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const Piece& piece = plan.pieces[i];
    const double turn = check.turn[i];
    most = std::max(most, length(check.displacement[i]) + std::abs(turn) * piece.circle);
    for (const Point& p : piece.outline.outer)
      most = std::max(
          most, length(check.displacement[i] + turn * left(p - plan.carrier(static_cast<int>(i)).center)));
  }
  return most;
}

double largest_rotation(const Plan& plan, Order order) {
  const StaticCheck check = static_check(plan, order);
  if (has_buckled(check)) return unlimited;
  double most = 0;
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (plan.joints[i].stiffness.M < unlimited && std::isfinite(check.joints[i].M))
      most = std::max(most, std::abs(check.joints[i].M) / plan.joints[i].stiffness.M);
  return most;
}

double mass_of(const Plan& plan) {
  return std::accumulate(plan.pieces.begin(), plan.pieces.end(), 0., [](double sum, const Piece& piece) {
    return sum + (piece.part_of < 0 ? piece.mass : 0);
  });
}

bool is_at_most(Measure measure) {
  return measure == Measure::displacement || measure == Measure::rotation || measure == Measure::mass;
}

void require_positive(double target) {
  if (!(target > 0 && target < unlimited))
    throw InvalidInput({{"target", "is " + to_string(target), "give a finite one above 0"}});
}

void scale(Material& m, Property property, double factor) {
  if (property == Property::youngs_modulus) m.youngs_modulus *= factor;
  if (property == Property::damping_ratio) m.damping_ratio *= factor;
  if (property == Property::yield_stress) scale_strength(m, factor);
}

void scale(BodyDef& body, Property property, double factor) {
  if (property == Property::depth) body.depth *= factor;
  if (body.material) scale(*body.material, property, factor);
  for (Region& region : body.profile) scale(region.material, property, factor);
}

double value_of(const BodyDef& body, Property property) {
  if (property == Property::depth && body.profile.empty()) return body.depth;
  const Material m =
      !body.profile.empty() ? body.profile.front().material : body.material.value_or(Material{});
  return property == Property::yield_stress     ? m.yield_stress
         : property == Property::youngs_modulus ? m.youngs_modulus
         : property == Property::damping_ratio  ? m.damping_ratio
                                                : 0;
}

}  // namespace

bool has_order(Measure measure) {
  return measure == Measure::reserve || measure == Measure::collapse || measure == Measure::displacement ||
         measure == Measure::rotation;
}

double measured(const Plan& plan, Measure measure, Order order) {
  switch (measure) {
    case Measure::reserve:
      return static_check(plan, order).reserve;
    case Measure::collapse:
      return order == Order::first ? limit_analysis(plan).load_factor : second_order_limit(plan).load_factor;
    case Measure::displacement:
      return largest_displacement(plan, order);
    case Measure::rotation:
      return largest_rotation(plan, order);
    case Measure::frequency:
      return slowest_mode(plan).frequency;
    case Measure::damping:
      return slowest_mode(plan).damping_ratio;
    case Measure::mass:
      return mass_of(plan);
  }
  return 0;
}

Reach reach(const SceneDef& scene, const std::vector<std::size_t>& bodies, Property property, Measure measure,
            double target, Order order) {
  require_positive(target);
  for (const std::size_t i : bodies)
    if (!(value_of(scene.bodies[i], property) > 0))
      throw InvalidInput({{"body '" + scene.bodies[i].name + "'", "has no such number to change",
                           "choose another body, or another property"}});
  Reach result;
  std::string governs;
  const auto reached = [&](double factor) {
    result.scene = scene;
    for (const std::size_t i : bodies) scale(result.scene.bodies[i], property, factor);
    const Plan plan = calibrate(result.scene);
    result.reached = measured(plan, measure, order);
    governs = "at " + to_string(factor) + " times what it is, it is " + to_string(result.reached);
    if (measure == Measure::reserve) governs += ", governed by " + governing(plan, static_check(plan, order));
    return result.reached;
  };
  const bool falls = measure == Measure::displacement || measure == Measure::rotation;
  factor_for(
      target, reached, [&] { return governs; }, falls ? -1 : 1);
  result.value = value_of(result.scene.bodies[bodies.front()], property);
  return result;
}

Reach first_to_reach(const std::vector<SceneDef>& candidates, Measure measure, double target, Order order) {
  require_positive(target);
  constexpr double within = 1e-9;  // of the target, as reach() meets it
  std::optional<double> best;
  bool yields = true;
  std::vector<Problem> refused;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Plan plan;
    try {
      plan = calibrate(candidates[i]);
    } catch (const InvalidInput& error) {
      refused = error.problems();
      continue;
    }
    const double reached = measured(plan, measure, order);
    if (reached == unlimited && !is_at_most(measure)) {  // as of a single piece, which is rigid
      yields = false;
      continue;
    }
    if (is_at_most(measure) ? reached <= (1 + within) * target : reached >= (1 - within) * target)
      return {static_cast<double>(i), reached, candidates[i]};
    if (!best || (is_at_most(measure) ? reached < *best : reached > *best)) best = reached;
  }
  if (!best && !yields)
    throw InvalidInput({{"target", "no load of this kind makes any of the list yield",
                         "split what is of one piece, which is rigid, or give loads that bend it"}});
  if (!best && !refused.empty()) throw InvalidInput(std::move(refused));
  throw InvalidInput(
      {{"target", "none of the list reaches it: the best comes to " + to_string(best.value_or(0)),
        "list stronger ones, or change the target"}});
}

Reach lightest(const std::vector<SceneDef>& candidates, Measure measure, double target, Order order) {
  std::vector<double> mass(candidates.size());
  std::transform(candidates.begin(), candidates.end(), mass.begin(),
                 [](const SceneDef& scene) { return mass_of(calibrate(scene)); });
  std::vector<std::size_t> sorted(candidates.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::size_t a, std::size_t b) { return mass[a] < mass[b]; });
  std::vector<SceneDef> by_mass;
  by_mass.reserve(sorted.size());
  for (const std::size_t i : sorted) by_mass.push_back(candidates[i]);
  Reach reach = first_to_reach(by_mass, measure, target, order);
  reach.value = static_cast<double>(sorted[static_cast<std::size_t>(reach.value)]);
  return reach;
}

void set_profile(SceneDef& scene, std::size_t index, std::vector<Region> profile, const std::string& name) {
  BodyDef& body = scene.bodies[index];
  const auto [from, to] = strip_line(body);
  const Point across = left(unit(to - from));
  const auto extent = [](const Ring& ring, Point direction) {
    double low = unlimited, high = -unlimited;
    for (const Point& p : ring) {
      low = std::min(low, dot(p, direction));
      high = std::max(high, dot(p, direction));
    }
    return std::pair(low, high);
  };
  double bottom = unlimited, top = -unlimited;
  for (const Region& region : profile) {
    const auto [low, high] = extent(region.outline.outer, {0, 1});
    bottom = std::min(bottom, low);
    top = std::max(top, high);
  }
  const auto [low, high] = extent(body.outline.outer, across);
  const double middle = (low + high) / 2, factor = (top - bottom) / (high - low);
  const auto stretch = [&](Point& p) { p = p + (factor - 1) * (dot(p, across) - middle) * across; };
  for (Point& p : body.outline.outer) stretch(p);
  for (Ring& hole : body.outline.holes)
    for (Point& p : hole) stretch(p);
  for (auto& cut : body.cuts)
    for (Point& p : cut) stretch(p);
  const Frame frame{body.at, body.angle};
  const auto in_the_world = [&](Point& p) {
    Point own = frame.local(p);
    stretch(own);
    p = frame.world(own);
  };
  for (SupportDef& support : scene.supports)
    if (support.body == body.name) in_the_world(support.at);
  for (LoadDef& load : scene.loads)
    if (load.body == body.name) in_the_world(load.at);
  body.depth = 1;
  body.profile = std::move(profile);
  body.profile_name = name;
}

}  // namespace ductile
