// SPDX-License-Identifier: BSD-3-Clause
#include "normal_equations.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::smoothing {
namespace {

template <int D>
Eigen::Matrix<double, D, D> whitening(const Eigen::Matrix<double, D, D>& covariance) {
  Eigen::Matrix<double, D, D> W = Eigen::Matrix<double, D, D>::Identity();
  covariance.llt().matrixL().solveInPlace(W);
  return W;
}

Eigen::Matrix2d whitening_of(const core::Observation& observation) {
  Eigen::Matrix2d W = Eigen::Matrix2d::Identity();
  if (observation.z.size() == 2) return whitening<2>(observation.R);
  W(0, 0) = 1.0 / std::sqrt(observation.R(0, 0));
  return W;
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

NormalEquations::NormalEquations(const Problem& problem, const Layout& layout, const RobustKernel& kernel)
    : problem_(problem), layout_(layout), kernel_(kernel) {
  for (const auto& edge : problem.graph.pose_edges) W_odometry_.push_back(whitening<3>(edge.covariance));
  for (const auto& edge : problem.graph.landmark_edges) W_landmark_.push_back(whitening_of(edge.observation));
  for (const auto& edge : problem.graph.fix_edges) W_fix_.push_back(whitening<2>(edge.fix.covariance_m2));
  for (const auto& prior : problem.pose_priors) W_pose_prior_.push_back(whitening<3>(prior.covariance));
  for (const auto& prior : problem.landmark_priors) W_landmark_prior_.push_back(whitening<2>(prior.covariance_m2));
  analyse();
}

template <int D, typename Visitor>
void NormalEquations::visit_observation(std::size_t i, const State& state, Chi2& chi2, Visitor&& visitor) const {
  const auto& edge = problem_.graph.landmark_edges[i];
  auto factor = observation_factor<D>(edge, state.poses[index(edge.pose)], state.landmarks[index(edge.landmark)]);
  const Eigen::Matrix<double, D, D> W = W_landmark_[i].topLeftCorner<D, D>();
  factor.e = W * factor.e;
  const double squared = factor.e.squaredNorm();
  const KernelValue kernel = smoothing::evaluate(kernel_, squared);
  chi2.landmarks += squared;
  chi2.cost += kernel.cost;
  visitor.binary(factor, W, kernel.weight, layout_.pose_column[index(edge.pose)],
                 layout_.landmark_column[index(edge.landmark)], landmark_slot_[i]);
}

template <typename Visitor>
void NormalEquations::visit_landmark_edge(std::size_t i, const State& state, Chi2& chi2, Visitor&& visitor) const {
  const auto& edge = problem_.graph.landmark_edges[i];
  try {
    if (core::dimension(edge.observation.kind) == 2) {
      visit_observation<2>(i, state, chi2, visitor);
    } else {
      visit_observation<1>(i, state, chi2, visitor);
    }
  } catch (const core::NumericalError& error) {
    throw core::NumericalError("smoothing: " + pose_name(problem_, edge.pose) + " sees " +
                               landmark_name(problem_, edge.landmark) + ": " + error.what());
  }
}

template <typename Visitor>
Chi2 NormalEquations::visit(const State& state, Visitor&& visitor) const {
  const core::LandmarkGraph& graph = problem_.graph;
  Chi2 chi2;
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    const auto& edge = graph.pose_edges[i];
    auto factor = odometry_factor(edge, state.poses[index(edge.from)], state.poses[index(edge.to)]);
    factor.e = W_odometry_[i] * factor.e;
    chi2.odometry += factor.e.squaredNorm();
    visitor.binary(factor, W_odometry_[i], 1.0, layout_.pose_column[index(edge.from)],
                   layout_.pose_column[index(edge.to)], odometry_slot_[i]);
  }
  for (std::size_t i = 0; i < graph.landmark_edges.size(); ++i) {
    visit_landmark_edge(i, state, chi2, visitor);
  }
  visit_priors(state, chi2, visitor);
  chi2.cost += chi2.odometry + chi2.priors;
  return chi2;
}

template <typename Visitor>
void NormalEquations::visit_priors(const State& state, Chi2& chi2, Visitor&& visitor) const {
  const core::LandmarkGraph& graph = problem_.graph;
  const auto unary = [&](auto factor, const auto& W, int column) {
    factor.e = W * factor.e;
    chi2.priors += factor.e.squaredNorm();
    visitor.unary(factor, W, column);
  };
  for (std::size_t i = 0; i < graph.fix_edges.size(); ++i) {
    const auto& edge = graph.fix_edges[i];
    unary(fix_factor(edge.fix, state.poses[index(edge.pose)]), W_fix_[i], layout_.pose_column[index(edge.pose)]);
  }
  for (std::size_t i = 0; i < problem_.pose_priors.size(); ++i) {
    const PosePrior& prior = problem_.pose_priors[i];
    unary(prior_factor(prior, state.poses[index(prior.pose)]), W_pose_prior_[i],
          layout_.pose_column[index(prior.pose)]);
  }
  for (std::size_t i = 0; i < problem_.landmark_priors.size(); ++i) {
    const LandmarkPrior& prior = problem_.landmark_priors[i];
    unary(prior_factor(prior, state.landmarks[index(prior.landmark)]), W_landmark_prior_[i],
          layout_.landmark_column[index(prior.landmark)]);
  }
}

/// Adds factors, e already whitened, to H and g.
struct NormalEquations::Assembler {
  NormalEquations& equations;

  template <int N>
  void add_diagonal(int column, const Eigen::Matrix<double, N, N>& block) {
    for (int c = 0; c < N; ++c) {
      double* value = &equations.values[index(equations.column_start[index(column + c)] +
                                              equations.diagonal_offset_[index(column + c)])];
      for (int r = 0; r <= c; ++r) value[r] += block(r, c);
    }
  }

  template <int R, int C>
  void add_block(const Slot& slot, const Eigen::Matrix<double, R, C>& block) {
    for (int c = 0; c < C; ++c) {
      double* value = &equations.values[index(equations.column_start[index(slot.column + c)] + slot.offset)];
      for (int r = 0; r < R; ++r) value[r] += block(r, c);
    }
  }

  template <int D, int N>
  void add_variable(int column, const Eigen::Matrix<double, D, N>& A, const Eigen::Matrix<double, D, 1>& e,
                    double weight) {
    if (column < 0) return;
    add_diagonal<N>(column, weight * A.transpose() * A);
    equations.gradient.template segment<N>(column) += weight * A.transpose() * e;
  }

  template <int D, int NA, int NB>
  void binary(const BinaryFactor<D, NA, NB>& factor, const Eigen::Matrix<double, D, D>& W, double weight, int column_a,
              int column_b, const Slot& slot) {
    const Eigen::Matrix<double, D, NA> A = W * factor.J_a;
    const Eigen::Matrix<double, D, NB> B = W * factor.J_b;
    add_variable<D, NA>(column_a, A, factor.e, weight);
    add_variable<D, NB>(column_b, B, factor.e, weight);
    if (slot.column < 0) return;
    if (column_a < column_b) {
      add_block<NA, NB>(slot, weight * A.transpose() * B);
    } else {
      add_block<NB, NA>(slot, weight * B.transpose() * A);
    }
  }

  template <int D, int N>
  void unary(const UnaryFactor<D, N>& factor, const Eigen::Matrix<double, D, D>& W, int column) {
    const Eigen::Matrix<double, D, N> A = W * factor.J_a;
    add_variable<D, N>(column, A, factor.e, 1.0);
  }
};

namespace {

struct NoAssembler {
  template <typename... Arguments>
  void binary(const Arguments&...) {}
  template <typename... Arguments>
  void unary(const Arguments&...) {}
};

}  // namespace

Chi2 NormalEquations::evaluate(const State& state) const { return visit(state, NoAssembler{}); }

Chi2 NormalEquations::linearize(const State& state) {
  std::fill(values.begin(), values.end(), 0.0);
  gradient.setZero();
  return visit(state, Assembler{*this});
}

void NormalEquations::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& Hx) const {
  Hx = Eigen::VectorXd::Zero(layout_.columns);
  for (int c = 0; c < layout_.columns; ++c) {
    for (int k = column_start[index(c)]; k < column_start[index(c) + 1]; ++k) {
      const int r = row_index[index(k)];
      Hx[r] += values[index(k)] * x[c];
      if (r != c) Hx[c] += values[index(k)] * x[r];
    }
  }
}

Eigen::VectorXd NormalEquations::diagonal() const {
  Eigen::VectorXd diagonal(layout_.columns);
  for (int c = 0; c < layout_.columns; ++c) diagonal[c] = values[index(column_start[index(c) + 1] - 1)];
  return diagonal;
}

void NormalEquations::damp(double damping, std::vector<double>& damped) const {
  damped = values;
  for (int c = 0; c < layout_.columns; ++c) damped[index(column_start[index(c) + 1] - 1)] *= 1.0 + damping;
}

}  // namespace helixnav::smoothing
