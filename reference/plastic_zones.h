// Plane frames of rolled sections by plastic zones: yielding that spreads along the bars and over their
// sections, with residual stresses of rolling. It shares nothing with the solver; for frames at rest alone.
//
// Elements of two nodes, cubic across and with strain ε + αξ along the axis, α so that N is even; strains to
// second order, ε = u' + mean of ½w'², so that all displacements must be small against an element's frame.
// Fibres are elastic and perfectly plastic, and unload elastically. Newton's method under one displacement
// that is prescribed, step by step, finds the factor on all loads, whose maximum is that of collapse.
//
// Residual stresses as ECCS (Ultimate Limit State Calculation of Sway Frames, 1984) has them: linear, of a
// share of the yield stress, tension where flanges meet the web, compression at flanges' tips and in mid web.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "ductile/rolled.h"

namespace ductile {

class PlasticZones {
 public:
  PlasticZones(double youngs_modulus, double yield_stress) : E(youngs_modulus), fy(yield_stress) {}

  struct Fibre {
    double y, area, residual;  // m, m², Pa
  };
  struct Element {
    int a, b;
    double length, c, s;
    std::size_t section;
  };
  struct Node {
    double x, y;
    std::array<double, 3> load{};
    bool fixed = false;
  };

  double E, fy;  // Pa
  std::vector<std::vector<Fibre>> sections;
  std::vector<Node> nodes;
  std::vector<Element> elements;

  /// Of flanges in three layers, a web, and fillets as one fibre each; its index.
  std::size_t section(const Rolled& of, double residual_share) {
    constexpr int across = 10, layers = 3, web = 20;
    const double peak = residual_share * fy, clear = of.h - 2 * of.tf;
    std::vector<Fibre> fibres;
    for (const int side : {-1, 1}) {
      for (int l = 0; l < layers; ++l)
        for (int i = 0; i < across; ++i)
          fibres.push_back({side * (of.h / 2 - of.tf * (l + 0.5) / layers), of.b * of.tf / layers / across,
                            peak * (1 - 2 * (i + 0.5) / across)});
      // What a square has beyond its quarter of a circle, two of them, whose centroid is 0.2234 r off.
      fibres.push_back(
          {side * (clear / 2 - 0.2234 * of.r), 2 * (1 - std::numbers::pi / 4) * of.r * of.r, peak / 2});
    }
    for (int i = 0; i < web; ++i) {
      const double y = clear * ((i + 0.5) / web - 0.5);
      fibres.push_back({y, of.tw * clear / web, peak * (4 * std::abs(y) / clear - 1)});
    }
    double force = 0, area = 0;
    for (const Fibre& f : fibres) force += f.residual * f.area, area += f.area;
    for (Fibre& f : fibres) f.residual -= force / area;
    sections.push_back(std::move(fibres));
    return sections.size() - 1;
  }

  int node(double x, double y) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (std::hypot(nodes[i].x - x, nodes[i].y - y) < 1e-9) return static_cast<int>(i);
    nodes.push_back({x, y});
    return static_cast<int>(nodes.size()) - 1;
  }
  Node& at(double x, double y) { return nodes[static_cast<std::size_t>(node(x, y))]; }
  void member(std::size_t section, double x0, double y0, double x1, double y1, int parts) {
    const double along = std::hypot(x1 - x0, y1 - y0);
    int last = node(x0, y0);
    for (int i = 1; i <= parts; ++i) {
      const double t = 1.0 * i / parts;
      const int next = node(x0 + t * (x1 - x0), y0 + t * (y1 - y0));
      elements.push_back({last, next, along / parts, (x1 - x0) / along, (y1 - y0) / along, section});
      last = next;
    }
  }

  /// The largest factor on all loads while the node is moved across step by step, m, until it has fallen by
  /// half a per cent; 0 where equilibrium is not found.
  double collapse(int moved, double step) {
    state_.assign(elements.size(), {});
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (auto& point : state_[e].points)
        point.plastic.assign(sections[elements[e].section].size(), 0), point.trial = point.plastic;
    const auto n = static_cast<Eigen::Index>(3 * nodes.size()), at = Eigen::Index{3} * moved;
    u_ = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd loads = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      if (!is_fixed(i))
        loads[i] = nodes[static_cast<std::size_t>(i / 3)].load[static_cast<std::size_t>(i % 3)];
    double factor = 0, highest = 0;
    for (int k = 1; factor > 0.995 * highest || k == 1; ++k) {
      bool found = false;
      for (int round = 0; round < 40 && !found; ++round) {
        assemble();
        const Eigen::VectorXd left = factor * loads - inner_;
        const double way = k * step - u_[at];
        if (round > 0 && left.norm() < 1e-9 * loads.norm() && std::abs(way) < 1e-10) {
          found = true;
          break;
        }
        const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(stiffness_);
        const Eigen::VectorXd by_rest = lu.solve(left), by_loads = lu.solve(loads);
        const double more = (way - by_rest[at]) / by_loads[at];
        u_ += by_rest + more * by_loads;
        factor += more;
      }
      if (!found) return 0;
      for (State& s : state_)
        for (auto& point : s.points) point.plastic = point.trial;
      highest = std::max(highest, factor);
    }
    return highest;
  }

 private:
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Matrix = Eigen::Matrix<double, 6, 6>;
  struct State {
    double alpha = 0;
    struct Point {
      std::vector<double> plastic, trial;  // strains of the fibres
    };
    std::array<Point, 2> points;  // of Gauss
  };
  struct Forces {
    double N = 0, M = 0, EA = 0, ES = 0, EI = 0;
  };
  std::vector<State> state_;
  Eigen::VectorXd u_, inner_;
  Eigen::SparseMatrix<double> stiffness_;

  bool is_fixed(Eigen::Index dof) const { return nodes[static_cast<std::size_t>(dof / 3)].fixed; }

  Forces forces(const std::vector<Fibre>& section, State::Point& point, double strain,
                double curvature) const {
    constexpr double after_yield = 1e-4;  // of E in the tangent alone, so that it stays regular
    Forces sum;
    for (std::size_t i = 0; i < section.size(); ++i) {
      const Fibre& f = section[i];
      double stress = E * (strain - f.y * curvature - point.plastic[i]) + f.residual, tangent = E;
      const double beyond = stress - std::clamp(stress, -fy, fy);
      point.trial[i] = point.plastic[i] + beyond / E;
      if (beyond != 0) stress -= beyond, tangent *= after_yield;
      sum.N += stress * f.area;
      sum.M -= stress * f.area * f.y;
      sum.EA += tangent * f.area;
      sum.ES -= tangent * f.area * f.y;
      sum.EI += tangent * f.area * f.y * f.y;
    }
    return sum;
  }

  void assemble() {
    std::vector<Eigen::Triplet<double>> entries;
    inner_ = Eigen::VectorXd::Zero(u_.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const Element& element = elements[e];
      std::array<Eigen::Index, 6> dof;
      for (std::size_t k = 0; k < 6; ++k)
        dof[k] = Eigen::Index{3} * (k < 3 ? element.a : element.b) + static_cast<Eigen::Index>(k % 3);
      Matrix turn = Matrix::Identity();
      for (const int k : {0, 3}) turn.block<2, 2>(k, k) << element.c, element.s, -element.s, element.c;
      Vector q;
      for (std::size_t k = 0; k < 6; ++k) q[static_cast<Eigen::Index>(k)] = u_[dof[k]];
      Vector force;
      Matrix K;
      answer(e, turn * q, force, K);
      force = (turn.transpose() * force).eval();
      K = (turn.transpose() * K * turn).eval();
      for (std::size_t i = 0; i < 6; ++i) {
        if (is_fixed(dof[i])) continue;
        inner_[dof[i]] += force[static_cast<Eigen::Index>(i)];
        for (std::size_t k = 0; k < 6; ++k)
          if (!is_fixed(dof[k]))
            entries.emplace_back(dof[i], dof[k],
                                 K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      }
    }
    for (Eigen::Index i = 0; i < u_.size(); ++i)
      if (is_fixed(i)) entries.emplace_back(i, i, 1);
    stiffness_.resize(u_.size(), u_.size());
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  // Of an element whose nodes are displaced by q in its own frame.
  void answer(std::size_t e, const Vector& q, Vector& force, Matrix& K) {
    const double L = elements[e].length;
    const auto& section = sections[elements[e].section];
    State& state = state_[e];
    // The mean of w'² is qᵀ G q.
    Matrix G = Matrix::Zero();
    constexpr std::array<int, 4> bending{1, 2, 4, 5};
    const double mean[4][4] = {{36, 3 * L, -36, 3 * L},
                               {3 * L, 4 * L * L, -3 * L, -L * L},
                               {-36, -3 * L, 36, -3 * L},
                               {3 * L, -L * L, -3 * L, 4 * L * L}};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) G(bending[i], bending[k]) = mean[i][k] / (30 * L * L);
    Vector along = G * q;
    along[0] -= 1 / L;
    along[3] += 1 / L;
    const double strain = (q[3] - q[0]) / L + q.dot(G * q) / 2;
    const std::array<double, 2> at{-1 / std::numbers::sqrt3, 1 / std::numbers::sqrt3};
    std::array<Vector, 2> across;
    std::array<Forces, 2> f;
    for (std::size_t p = 0; p < 2; ++p)
      across[p] << 0, 6 * at[p] / (L * L), (3 * at[p] - 1) / L, 0, -6 * at[p] / (L * L), (3 * at[p] + 1) / L;
    for (int round = 0; round < 30; ++round) {
      for (std::size_t p = 0; p < 2; ++p)
        f[p] = forces(section, state.points[p], strain + state.alpha * at[p], across[p].dot(q));
      const double uneven = f[1].N - f[0].N;
      if (std::abs(uneven) < 1e-11 * fy) break;
      state.alpha -= uneven / ((f[0].EA + f[1].EA) * at[1]);
    }
    force.setZero();
    K.setZero();
    Vector by_alpha = Vector::Zero();
    double of_alpha = 0, N = 0;
    for (std::size_t p = 0; p < 2; ++p) {
      force += L / 2 * (f[p].N * along + f[p].M * across[p]);
      N += f[p].N / 2;
      K += L / 2 *
           (f[p].EA * along * along.transpose() + f[p].EI * across[p] * across[p].transpose() +
            f[p].ES * (along * across[p].transpose() + across[p] * along.transpose()));
      by_alpha += L / 2 * at[p] * (f[p].EA * along + f[p].ES * across[p]);
      of_alpha += L / 2 * at[p] * at[p] * f[p].EA;
    }
    K += L * N * G - by_alpha * by_alpha.transpose() / of_alpha;
  }
};

}  // namespace ductile
