// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "factors.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "layout.hpp"

namespace helixnav::smoothing {

/// H = Σ JᵀC⁻¹J (upper triangle, compressed columns) and g = Σ JᵀC⁻¹e of a problem whose structure does not change: the
/// pattern and the place of every factor's blocks in it are found once. The problem must outlive it.
class NormalEquations {
 public:
  NormalEquations(const Problem& problem, const Layout& layout, const RobustKernel& kernel);

  /// χ² of a state. NumericalError naming pose and landmark when a landmark stands at the sensor.
  Chi2 evaluate(const State& state) const;

  /// The same, and H and g at that state.
  Chi2 linearize(const State& state);

  /// H·x from the stored upper triangle.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& Hx) const;

  std::vector<int> column_start;
  std::vector<int> row_index;
  std::vector<double> values;
  Eigen::VectorXd gradient;
  Eigen::VectorXd diagonal() const;

  /// Values with the diagonal multiplied by 1 + damping.
  void damp(double damping, std::vector<double>& damped) const;

 private:
  /// Where a block row_variable × column_variable begins inside each of the columns of column_variable.
  struct Slot {
    int row_column = -1;  ///< first column of the row variable; −1: one of the two is fixed
    int column = -1;
    int offset = 0;
  };

  void analyse();
  Slot slot(int column_a, int column_b) const;

  template <typename Visitor>
  Chi2 visit(const State& state, Visitor&& visitor) const;
  template <typename Visitor>
  void visit_priors(const State& state, Chi2& chi2, Visitor&& visitor) const;
  template <typename Visitor>
  void visit_landmark_edge(std::size_t edge, const State& state, Chi2& chi2, Visitor&& visitor) const;
  template <int D, typename Visitor>
  void visit_observation(std::size_t edge, const State& state, Chi2& chi2, Visitor&& visitor) const;

  struct Assembler;

  const Problem& problem_;
  const Layout& layout_;
  RobustKernel kernel_;
  std::vector<Eigen::Matrix3d> W_odometry_;  ///< C⁻¹ = WᵀW
  std::vector<Eigen::Matrix2d> W_landmark_;
  std::vector<Eigen::Matrix2d> W_fix_;
  std::vector<Eigen::Matrix3d> W_pose_prior_;
  std::vector<Eigen::Matrix2d> W_landmark_prior_;
  std::vector<Slot> odometry_slot_;
  std::vector<Slot> landmark_slot_;
  std::vector<int> diagonal_offset_;  ///< [column] offset of the first row of its variable inside the column
};

}  // namespace helixnav::smoothing
