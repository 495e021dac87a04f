// What a plan can do without: chosen from bounds, confirmed by running it with and without.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compare.h"
#include "ductile/design.h"
#include "ductile/plane.h"
#include "merge.h"
#include "response.h"
#include "yield.h"

namespace ductile {
namespace {

constexpr double resolution = 1e-6;  // of a structure's size: what Box2D's floats tell

std::size_t index(int i) { return static_cast<std::size_t>(i); }
std::string joints(std::size_t n) { return std::to_string(n) + (n == 1 ? " joint" : " joints"); }

class Leaner {
 public:
  Leaner(const Plan& plan, const LeaveOut& options)
      : options_(options),
        plan_(plan),
        full_(plan, options.impact),
        quiet_(index(full_.structures()), true),
        lean_{.plan = plan} {
    measure_structures();
    find_quiet();
    for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
      judged_.push_back(judge(static_cast<int>(i)));
      by_name_.emplace(plan_.joints[i].name, i);
    }
    budget_ = options.tolerance;
  }

  LeanPlan run() {
    for (const auto part : {&Leaner::merge_where_nothing_yields, &Leaner::merge_where_little_bends,
                            &Leaner::make_rigid, &Leaner::drop_caps, &Leaner::drop_solver}) {
      (this->*part)();
      ++parts_done_;
    }
    if (!lean_.plan.left_out.empty()) {
      const Comparison all = compared(plan_, JointSolver::direct, lean_.plan, lean_.solver, "all together");
      lean_.all = {.what = "all",
                   .error = options_.tolerance - budget_,
                   .measured = all.error,
                   .time_saved = all.time_saved};
    }
    return std::move(lean_);
  }

 private:
  // --- what the bounds say of the plan as it is ---

  void measure_structures() {
    std::vector<Point> low(quiet_.size(), {unlimited, unlimited}),
        high(quiet_.size(), {-unlimited, -unlimited});
    for (std::size_t i = 0; i < plan_.pieces.size(); ++i) {
      if (full_.structure()[i] < 0) continue;
      const std::size_t s = index(full_.structure()[i]);
      const Piece& piece = plan_.pieces[i];
      const auto add = [&](Point p) {
        low[s] = {std::min(low[s].x, p.x), std::min(low[s].y, p.y)};
        high[s] = {std::max(high[s].x, p.x), std::max(high[s].y, p.y)};
      };
      for (const Point& p : piece.outline.outer) add(p);
      add(piece.center - Point{piece.circle, piece.circle});
      add(piece.center + Point{piece.circle, piece.circle});
    }
    for (std::size_t s = 0; s < quiet_.size(); ++s) size_.push_back(length(high[s] - low[s]));
  }

  int structure_of(const PlannedJoint& joint) const {
    for (const int piece : {joint.a, joint.b})
      if (piece >= 0 && full_.structure()[index(piece)] >= 0) return full_.structure()[index(piece)];
    return -1;
  }

  // Of a joint; 0 in its free rows.
  template <class Force>
  std::array<double, 3> forces(int joint, const Yield& yield, const Force& force) const {
    std::array<double, 3> result{};
    for (const Row row : {axial, shear, rotation})
      if (!yield.is_free(row)) result[index(row)] = force(3 * joint + row);
    return result;
  }

  // Whatever their signs.
  static double usage(const Yield& yield, const std::array<double, 3>& force) {
    double most = 0;
    for (const double n : {-1., 1.})
      for (const double m : {-1., 1.})
        most = std::max(most, yield.usage({n * force[0], force[1], m * force[2]}));
    return most;
  }

  static bool whole(const Yield& yield) {
    return !yield.is_free(axial) && !yield.is_free(shear) && !yield.is_free(rotation);
  }

  // Structures in which no joint yields at the bound of its forces. What swings in a mechanism is bounded by
  // nothing here.
  void find_quiet() {
    for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
      const int s = structure_of(plan_.joints[i]);
      if (s < 0) continue;
      const Yield yield(plan_, plan_.joints[i]);
      const auto bound = forces(static_cast<int>(i), yield, [&](int row) { return full_.force(row); });
      if (!(usage(yield, bound) < 1) || (!whole(yield) && full_.statics().is_mechanism()))
        quiet_[index(s)] = false;
    }
    const bool any_loud = std::find(quiet_.begin(), quiet_.end(), false) != quiet_.end();
    // Where only one structure is there, its collapse bounds what it carries; where nothing yields at rest,
    // it does not collapse.
    if (any_loud && quiet_.size() == 1 && static_check(plan_).reserve < 1)
      at_most_ = std::min(1., limit_analysis(plan_).load_factor);
  }

  struct Judged {
    int structure;
    double bends;    // m: what its elasticity moves the farthest point of its structure by, at most
    bool may_go;     // it does not yield, and nobody holds it
    bool may_merge;  // and no row of it is free
  };

  // In a quiet structure by the bound of its forces. In others by an estimate, and only where nothing hits
  // them: loads that come at once swing to twice what statics say, and what collapses carries no more than
  // the collapse load.
  Judged judge(int i) const {
    const PlannedJoint& joint = plan_.joints[index(i)];
    const int s = structure_of(joint);
    if (s < 0 || (!quiet_[index(s)] && full_.impact() > 0)) return {s, 0, false, false};
    const Yield yield(plan_, joint);
    const auto force = forces(i, yield, [&](int row) {
      return quiet_[index(s)] ? full_.force(row) : 2 * at_most_ * full_.rest(row);
    });
    double bends = 0;
    for (const Row row : {axial, shear, rotation})
      if (const double f = force[index(row)]; f > 0)
        bends += f / full_.statics().stiffness()[3 * i + row] * (row == rotation ? size_[index(s)] : 1);
    const auto is_driven = [&](int piece) {
      return piece >= 0 &&
             plan_.bodies[index(plan_.pieces[index(piece)].body)].type == BodyType::kinematic_body;
    };
    const bool may_go = usage(yield, force) < 1 && !joint.hold && !is_driven(joint.a) && !is_driven(joint.b);
    return {s, bends, may_go, may_go && whole(yield)};
  }

  // --- trying a leaner plan ---

  // Null where nothing of a structure moves any more.
  std::unique_ptr<Response> response_of(const Plan& leaner) const {
    const bool any = std::any_of(leaner.joints.begin(), leaner.joints.end(),
                                 [&](const PlannedJoint& j) { return structure_of(j) >= 0; });
    return any ? std::make_unique<Response>(leaner, options_.impact) : nullptr;
  }

  // By structure: how far a piece may be from where it is in `plan`, over the structure's size.
  std::vector<double> promises(const Response& now, const Plan& leaner) const {
    const auto then = response_of(leaner);
    std::vector<double> result(quiet_.size());
    for (std::size_t i = 0; i < plan_.pieces.size(); ++i) {
      const int s = full_.structure()[i];
      if (s < 0) continue;
      const double apart = now.apart(then.get(), static_cast<int>(i), plan_.pieces[i].center);
      result[index(s)] = std::max(result[index(s)], apart / size_[index(s)]);
    }
    return result;
  }

  Comparison compared(const Plan& a, JointSolver with, const Plan& b, JointSolver instead,
                      const std::string& what) const {
    return compare(a, with, b, instead, options_.seconds, options_.stepping, full_.structure(), size_,
                   [&](double share) { tell(share, what); });
  }
  void tell(double share, const std::string& what) const {
    constexpr int parts = 6;
    if (options_.progress) options_.progress((parts_done_ + share) / parts, what);
  }

  // Takes what keeps its promise and saves time.
  void offer(Plan leaner, JointSolver solver, double promise, const std::string& what) {
    promise = std::max(promise, resolution);
    if (promise > budget_) return;
    const Comparison run = compared(lean_.plan, lean_.solver, leaner, solver, what);
    const LeftOut item{what, promise, run.error, run.time_saved};
    if (run.error > promise || run.saved_at_least <= 0) {
      lean_.kept.push_back(item);
      return;
    }
    leaner.left_out.push_back(item);
    lean_.plan = std::move(leaner);
    lean_.solver = solver;
    budget_ -= promise;
  }

  std::vector<int> by_bending(bool in_quiet) const {
    std::vector<int> result;
    for (std::size_t i = 0; i < judged_.size(); ++i)
      if (judged_[i].may_merge && quiet_[index(judged_[i].structure)] == in_quiet)
        result.push_back(static_cast<int>(i));
    std::stable_sort(result.begin(), result.end(),
                     [&](int i, int j) { return judged_[index(i)].bends < judged_[index(j)].bends; });
    return result;
  }

  void offer_merged(const Plan& leaner, double promise) {
    const std::size_t gone = lean_.plan.joints.size() - leaner.joints.size();
    if (gone > 0)
      offer(leaner, lean_.solver, promise, joints(gone) + " merged with the pieces at both sides");
  }

  // --- what can be left out ---

  // Where nothing yields the bound of the difference is rigorous. Of each structure as many joints as keep
  // within the budget, those that bend least first: found by bisection.
  void merge_where_nothing_yields() {
    const std::vector<int> order = by_bending(true);
    std::vector<std::size_t> good(quiet_.size()), bad(quiet_.size());  // counts: known to do; known not to
    for (const int i : order) ++bad[index(judged_[index(i)].structure)];
    std::vector<std::size_t> next = bad;
    for (std::size_t& b : bad) ++b;
    const auto with = [&](const std::vector<std::size_t>& count) {
      std::vector<std::size_t> taken(quiet_.size());
      std::vector<int> fused;
      for (const int i : order)
        if (const std::size_t s = index(judged_[index(i)].structure); taken[s]++ < count[s])
          fused.push_back(i);
      return merged(plan_, fused);
    };
    double promise = 0;
    const double rounds = std::log2(static_cast<double>(order.size()) + 1) + 1;
    for (int round = 0; next != good; ++round) {
      tell(std::min(1., round / rounds), "what may be merged");
      const std::vector<double> promised = promises(full_, with(next));
      for (std::size_t s = 0; s < quiet_.size(); ++s) {
        if (next[s] == good[s]) continue;
        (promised[s] <= budget_ ? good : bad)[s] = next[s];
        if (promised[s] <= budget_) promise = std::max(promise, promised[s]);
        next[s] = bad[s] - good[s] > 1 ? good[s] + (bad[s] - good[s]) / 2 : good[s];
      }
    }
    offer_merged(with(good), promise);
  }

  // Elsewhere a joint that by itself stays elastic is merged where all that it may bend is within the budget;
  // what yields beside it is not in that bound, so it is the run that decides.
  void merge_where_little_bends() {
    std::vector<double> sum(quiet_.size());
    std::vector<int> fused;
    for (const int i : by_bending(false)) {
      const Judged& j = judged_[index(i)];
      const double more = j.bends / size_[index(j.structure)];
      if (sum[index(j.structure)] + more > budget_ / 2) continue;
      sum[index(j.structure)] += more;
      fused.push_back(i);
    }
    if (fused.empty()) return;
    std::vector<int> still_there;
    for (const int i : fused)
      if (const int now = find(plan_.joints[index(i)].name); now >= 0) still_there.push_back(now);
    offer_merged(merged(lean_.plan, still_there), *std::max_element(sum.begin(), sum.end()));
  }

  // Stretch and shear of what is left in structures where nothing yields.
  void make_rigid() {
    Plan leaner = lean_.plan;
    std::size_t rows = 0;
    for (PlannedJoint& joint : leaner.joints) {
      const Judged& j = judged_of(joint);
      if (!j.may_go || !quiet_[index(j.structure)]) continue;
      rows += (joint.stiffness.N < unlimited) + (joint.stiffness.Q < unlimited);
      joint.stiffness.N = joint.stiffness.Q = unlimited;
    }
    if (rows == 0) return;
    const std::unique_ptr<Response> now = response_of(lean_.plan);
    const std::vector<double> promised = promises(*now, leaner);
    offer(std::move(leaner), lean_.solver, *std::max_element(promised.begin(), promised.end()),
          std::to_string(rows) + " rows rigid that would stretch or shear");
  }

  // Caps that cannot be reached, and with them the N–M–Q surface and the counting towards a break.
  void drop_caps() {
    Plan leaner = lean_.plan;
    std::size_t count = 0;
    for (PlannedJoint& joint : leaner.joints) {
      if (!judged_of(joint).may_go) continue;
      ++count;
      for (double* cap : {&joint.N, &joint.Nc, &joint.Q, &joint.M, &joint.M_reverse})
        if (*cap > 0) *cap = unlimited;
      joint.max_rotation = joint.max_elongation = joint.max_compression = joint.max_slip = unlimited;
    }
    if (count > 0)
      offer(std::move(leaner), lean_.solver, 0, joints(count) + " without caps, and never to break");
  }

  // A joint alone is solved as well by Box2D's own iterations: no bound says how well, the run does.
  void drop_solver() {
    std::vector<int> count(quiet_.size());
    for (const PlannedJoint& joint : lean_.plan.joints)
      if (const int s = structure_of(joint); s >= 0) ++count[index(s)];
    const bool alone = std::all_of(count.begin(), count.end(), [](int n) { return n <= 1; });
    if (alone && !lean_.plan.joints.empty())
      offer(lean_.plan, JointSolver::iterative, budget_, "structure solver: each joint is alone");
  }

  int find(const std::string& joint) const {
    const auto& all = lean_.plan.joints;
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const PlannedJoint& j) { return j.name == joint; });
    return it == all.end() ? -1 : static_cast<int>(it - all.begin());
  }

  const Judged& judged_of(const PlannedJoint& joint) const { return judged_[by_name_.at(joint.name)]; }

  const LeaveOut& options_;
  double at_most_ = 1;  // of the loads
  const Plan& plan_;
  Response full_;
  std::vector<bool> quiet_;                               // structures in which nothing can yield
  std::vector<double> size_;                              // m, of structures
  std::vector<Judged> judged_;                            // by Plan::joints
  std::unordered_map<std::string, std::size_t> by_name_;  // into them
  double budget_ = 0;
  int parts_done_ = 0;  // of run()
  LeanPlan lean_;
};

double until_all_is_over(const Plan& plan) {
  double last = plan.gravity_ramp;
  for (const Plan::Load& load : plan.loads)
    last = std::max(last, load.def.to < unlimited ? load.def.to : load.def.from + load.def.ramp);
  return last + 5;
}

}  // namespace

LeanPlan leave_out(const Plan& plan, const LeaveOut& options) {
  if (plan.has_lines_or_drives()) return {.plan = plan};
  LeaveOut complete = options;
  if (complete.seconds == 0) complete.seconds = until_all_is_over(plan);
  return Leaner(plan, complete).run();
}

}  // namespace ductile
