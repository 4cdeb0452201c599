// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "helixnav/cekf/filter_options.hpp"
#include "helixnav/cekf/match.hpp"
#include "helixnav/cekf/update_workspace.hpp"
#include "update/innovation.hpp"
#include "update/retraction.hpp"

namespace helixnav::cekf {

/// δ = P·gain of what is involved, and the retraction x ⊕ δ with its derivatives.
class InvolvedCorrection {
 public:
  InvolvedCorrection(Retraction retraction, const UpdateWorkspace& w);

  /// Moves δ the given fraction of the way from `from` to the one given by w.gain.
  void go_towards(const InvolvedCorrection& from, double fraction, const UpdateWorkspace& w);
  /// Largest element of the difference.
  double largest() const { return delta_.cwiseAbs().maxCoeff(); }
  double distance(const InvolvedCorrection& other) const { return (delta_ - other.delta_).cwiseAbs().maxCoeff(); }
  /// By how much rounding may change δ = P·gain: more than a step, for a map whose place in its frame is
  /// known to hundreds of metres.
  double rounding(const UpdateWorkspace& w) const;
  /// |δ|²_P + |ν|²_R with ν of w; infinite if R is not positive definite.
  double cost(const UpdateWorkspace& w) const;
  /// w.pose and w.points_m become x ⊕ δ.
  void place(UpdateWorkspace& w) const;
  /// H, by the state at x ⊕ δ, becomes H by δ, and ν becomes ν + H·δ: the Gauss-Newton step from zero.
  void refer_to_delta(UpdateWorkspace& w) const;
  /// H, by the state at x ⊕ δ, becomes H·N, N the transport of errors from x to x ⊕ δ.
  void refer_to_transported_errors(UpdateWorkspace& w) const;
  const Eigen::VectorXd& gain() const { return gain_; }

 private:
  Retraction retraction_;
  core::Pose2 pose_;
  std::vector<Eigen::Vector2d> points_m_;
  Eigen::VectorXd gain_;
  Eigen::VectorXd delta_;
};

/// Gauss-Newton to the minimum of |δ|²_P + |ν(x ⊕ δ)|²_R over what is involved, `linearise` filling H, R, ν at w.pose and
/// w.points_m. A step that raises the cost is halved. Returns the cost at the minimum, with w solved there; infinity when
/// the iteration does not settle.
template <class Linearise>
double iterate_to_minimum(InvolvedCorrection& correction, UpdateWorkspace& w, int max_iterations, const char* verb,
                          const Linearise& linearise) {
  constexpr double settled = 1e-9;
  linearise(w);
  double cost = correction.cost(w);
  for (int k = 0; k < max_iterations; ++k) {
    correction.refer_to_delta(w);
    const double cost_at_fixed_point = solve_innovation(w, verb);
    const InvolvedCorrection before = correction;
    const UpdateWorkspace solved = w;
    correction.go_towards(before, 1.0, solved);
    const double least_step = std::max(settled * (1.0 + correction.largest()), correction.rounding(solved));
    if (correction.distance(before) < least_step) return cost_at_fixed_point;
    double next = std::numeric_limits<double>::infinity();
    for (double fraction = 1.0; fraction > 1e-3; fraction *= 0.5) {
      correction.go_towards(before, fraction, solved);
      correction.place(w);
      linearise(w);
      next = correction.cost(w);
      if (next <= cost * (1.0 + 1e-9)) break;
    }
    cost = next;
  }
  return std::numeric_limits<double>::infinity();
}

/// G and L of an update linearised at the minimum, with the gain found there kept.
template <class Linearise>
void linearise_at_minimum(const InvolvedCorrection& correction, UpdateWorkspace& w, const char* verb,
                          const Linearise& linearise) {
  correction.place(w);
  linearise(w);
  correction.refer_to_transported_errors(w);
  solve_innovation(w, verb);
  w.gain.view().col(0) = correction.gain();
}

/// The share of each row pair k, k+1 … in the cost of the last solve_innovation: λ_kᵀ·S_kk·λ_k with λ = S⁻¹ν.
std::vector<double> cost_by_part(const UpdateWorkspace& w, const std::vector<int>& rows_of_part);

}  // namespace helixnav::cekf
