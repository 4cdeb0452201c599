// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

#include "helixnav/atlas/phase_factor.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "phase/phase_equations.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// Prior information on points of the shape, laid out for the kept unknowns.
struct PriorInformation {
  std::vector<std::size_t> place;  ///< in shape.ids
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd information;
};

PriorInformation prior_on(const PhaseShape& shape, const PointPrior* prior) {
  PriorInformation result;
  if (prior == nullptr) return result;
  std::vector<Index> rows;
  for (std::size_t i = 0; i < prior->ids.size(); ++i) {
    const auto found = std::lower_bound(shape.ids.begin(), shape.ids.end(), prior->ids[i]);
    if (found == shape.ids.end() || *found != prior->ids[i]) continue;
    result.place.push_back(static_cast<std::size_t>(found - shape.ids.begin()));
    result.points_m.push_back(prior->points_m[i]);
    rows.push_back(2 * static_cast<Index>(i));
    rows.push_back(2 * static_cast<Index>(i) + 1);
  }
  const Index n = static_cast<Index>(rows.size());
  const Eigen::LLT<Eigen::MatrixXd> llt(prior->covariance(rows, rows));
  if (n > 0 && llt.info() != Eigen::Success) {
    throw core::PreconditionError("phase factor: covariance of the prior is not positive definite");
  }
  if (n > 0) result.information = llt.solve(Eigen::MatrixXd::Identity(n, n));
  return result;
}

void add_prior(const PriorInformation& prior, const PhaseShape& shape, Eigen::MatrixXd& A, Eigen::VectorXd& b) {
  for (std::size_t i = 0; i < prior.place.size(); ++i) {
    const Index at_i = 3 + 2 * static_cast<Index>(prior.place[i]);
    for (std::size_t j = 0; j < prior.place.size(); ++j) {
      const Index at_j = 3 + 2 * static_cast<Index>(prior.place[j]);
      const Eigen::Matrix2d W = prior.information.block<2, 2>(2 * static_cast<Index>(i), 2 * static_cast<Index>(j));
      A.block<2, 2>(at_i, at_j) += W;
      b.segment<2>(at_i) += W * (prior.points_m[j] - shape.points_m[prior.place[j]]);
    }
  }
}

/// Step of exit and points. What nothing determines stays where it is: the diagonal is raised by a billionth.
Eigen::VectorXd kept_step(const PhaseEquations& equations, const PriorInformation& prior, const PhaseShape& shape) {
  const Index n = equations.kept.rows() - 1;
  Eigen::MatrixXd A = equations.kept.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
  Eigen::VectorXd b = equations.kept.bottomRows<1>().head(n).transpose();
  add_prior(prior, shape, A, b);
  A.diagonal().array() = A.diagonal().array() * (1.0 + 1e-9) + 1e-9;
  return A.ldlt().solve(b);
}

void move_by(PhaseShape& shape, const Eigen::VectorXd& chain, const Eigen::VectorXd& kept) {
  const std::size_t T = shape.T_entry_robot.size();
  for (std::size_t k = 0; k < T; ++k) {
    const Eigen::Vector3d step = k + 1 < T ? chain.segment<3>(3 * static_cast<Index>(k)) : kept.head<3>();
    shape.T_entry_robot[k] = core::Pose2(Eigen::Vector3d(shape.T_entry_robot[k].vector() + step));
  }
  for (std::size_t i = 0; i < shape.points_m.size(); ++i) {
    shape.points_m[i] += kept.segment<2>(3 + 2 * static_cast<Index>(i));
  }
}

void check_shape(const PhaseLog& log, const PhaseShape& shape) {
  check_log(log);
  if (shape.T_entry_robot.size() != log.steps.size() || shape.ids != landmarks_of(log) ||
      shape.points_m.size() != shape.ids.size()) {
    throw core::PreconditionError("phase factor: the shape does not fit the log");
  }
}

PhaseFactor factor_about(const PhaseLog& log, PhaseShape shape) {
  PhaseEquations equations = linearise(log, shape);
  eliminate_chain(equations);
  const Index n = equations.kept.rows() - 1;
  PhaseFactor factor;
  factor.gaussian.information = equations.kept.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
  factor.gaussian.vector = equations.kept.bottomRows<1>().head(n).transpose();
  factor.gaussian.chi2 = equations.kept(n, n);
  factor.gaussian.mean.resize(n);
  factor.gaussian.mean.head<3>() = shape.T_entry_robot.back().vector();
  for (std::size_t i = 0; i < shape.points_m.size(); ++i) {
    factor.gaussian.mean.segment<2>(3 + 2 * static_cast<Index>(i)) = shape.points_m[i];
  }
  factor.shape = std::move(shape);
  return factor;
}

}  // namespace

PhaseFactor derive_factor(const PhaseLog& log, PhaseShape start, const PointPrior* prior, int rounds) {
  check_shape(log, start);
  const PriorInformation information = prior_on(start, prior);
  for (int round = 0; round < rounds; ++round) {
    PhaseEquations equations = linearise(log, start);
    eliminate_chain(equations);
    const Eigen::VectorXd kept = kept_step(equations, information, start);
    const Eigen::VectorXd chain = chain_step(equations, kept);
    move_by(start, chain, kept);
    constexpr double still = 1e-7;  // [m, rad]: the next step is smaller by orders of magnitude
    if (kept.cwiseAbs().maxCoeff() < still && (chain.size() == 0 || chain.cwiseAbs().maxCoeff() < still)) break;
  }
  return factor_about(log, std::move(start));
}

PhaseFactor rederive_factor(const PhaseLog& log, const PhaseFactor& old, const core::Pose2& T_entry_exit,
                            const std::vector<Eigen::Vector2d>& points_m, int rounds) {
  PhaseShape shape = old.shape;
  shape.points_m = points_m;
  check_shape(log, shape);
  shape.T_entry_robot.back() = T_entry_exit;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(3 + 2 * static_cast<Index>(points_m.size()));
  for (int round = 0; round < rounds && shape.T_entry_robot.size() > 1; ++round) {
    PhaseEquations equations = linearise(log, shape);
    eliminate_chain(equations);
    const Eigen::VectorXd step = chain_step(equations, still);
    move_by(shape, step, still);
    if (step.cwiseAbs().maxCoeff() < 1e-12) break;
  }
  return factor_about(log, std::move(shape));
}

}  // namespace helixnav::atlas
