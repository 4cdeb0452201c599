// SPDX-License-Identifier: BSD-3-Clause
#include "phase/phase_equations.hpp"

#include <algorithm>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// Where blocks of the equations are: pose 0 is the entry and has none, poses up to T−1 are in the chain, pose T is kept.
class Assembly {
 public:
  Assembly(PhaseEquations& equations, const PhaseShape& shape) : to_(equations), shape_(shape) {
    const Index T = static_cast<Index>(shape.T_entry_robot.size());
    const Index width = 3 + 2 * static_cast<Index>(shape.ids.size()) + 1;
    to_.diagonal.assign(static_cast<std::size_t>(T - 1), Eigen::Matrix3d::Zero());
    to_.next.assign(static_cast<std::size_t>(std::max<Index>(T - 2, 0)), Eigen::Matrix3d::Zero());
    to_.to_kept.setZero(3 * (T - 1), width);
    to_.kept.setZero(width, width);
  }

  core::Pose2 pose(Index k) const {
    return k == 0 ? core::Pose2() : shape_.T_entry_robot[static_cast<std::size_t>(k - 1)];
  }

  void add_motion(const LoggedStep& step, Index k) {
    const core::Pose2 T_from = pose(k - 1);
    const core::Pose2 T_to = pose(k);
    const Eigen::Matrix2d R = core::rotation(T_from.heading_rad).transpose();
    const Eigen::Vector2d moved_m = R * (T_to.position_m() - T_from.position_m());
    Eigen::Vector3d r;
    r.head<2>() = step.T_before_after.position_m() - moved_m;
    r[2] = core::wrap_to_pi(step.T_before_after.heading_rad - T_to.heading_rad + T_from.heading_rad);
    Eigen::Matrix3d J_from = Eigen::Matrix3d::Zero();
    J_from.topLeftCorner<2, 2>() = -R;
    J_from.col(2) << moved_m.y(), -moved_m.x(), -1.0;
    Eigen::Matrix3d J_to = Eigen::Matrix3d::Identity();
    J_to.topLeftCorner<2, 2>() = R;
    const Eigen::Matrix3d W = step.covariance.inverse();
    const Eigen::Matrix3d WJ_from = W * J_from;
    const Eigen::Matrix3d WJ_to = W * J_to;
    add_pose(k, J_to.transpose() * WJ_to, WJ_to.transpose() * r);
    if (k > 1) {
      add_pose(k - 1, J_from.transpose() * WJ_from, WJ_from.transpose() * r);
      if (is_exit(k)) {
        rows(k - 1).leftCols<3>() += J_from.transpose() * WJ_to;
      } else {
        to_.next[static_cast<std::size_t>(k - 2)] += J_from.transpose() * WJ_to;
      }
    }
    add_chi2(r.dot(W * r));
  }

  void add_observation(const SeenLandmark& seen, Index k) {
    const auto place = std::lower_bound(shape_.ids.begin(), shape_.ids.end(), seen.id) - shape_.ids.begin();
    const Index column = 3 + 2 * static_cast<Index>(place);
    const auto& z = seen.observation;
    const core::PredictedObservation h = core::predict_observation(z.kind, pose(k), seen.T_robot_sensor,
                                                                   shape_.points_m[static_cast<std::size_t>(place)]);
    const core::ObsVector r = core::innovation(z.kind, z.z, h.z_hat);
    if (core::dimension(z.kind) == 2) {
      add_rows<2>(h, r, z.R, column, k);
    } else {
      add_rows<1>(h, r, z.R, column, k);
    }
  }

 private:
  /// For an observation with N rows. Inverses of sizes unknown to the compiler took 8 % of a loop closure on Victoria Park.
  template <int N>
  void add_rows(const core::PredictedObservation& h, const core::ObsVector& innovation, const core::ObsMatrix& R,
                Index column, Index k) {
    const Eigen::Matrix<double, N, 2> H = h.H_landmark.topRows<N>();
    const Eigen::Matrix<double, N, 3> H_pose = h.H_pose.topRows<N>();
    const Eigen::Matrix<double, N, 1> r = innovation.head<N>();
    const Eigen::Matrix<double, N, N> W = R.topLeftCorner<N, N>().inverse();
    const Eigen::Matrix<double, N, 2> WH = W * H;
    const Eigen::Matrix<double, N, 1> Wr = W * r;
    to_.kept.block<2, 2>(column, column) += H.transpose() * WH;
    to_.kept.bottomRows<1>().segment<2>(column) += r.transpose() * WH;
    add_chi2(r.dot(Wr));
    if (k == 0) return;
    add_pose(k, H_pose.transpose() * W * H_pose, H_pose.transpose() * Wr);
    const Eigen::Matrix<double, 3, 2> cross = H_pose.transpose() * WH;
    if (is_exit(k)) {
      to_.kept.block<2, 3>(column, 0) += cross.transpose();
    } else {
      rows(k).middleCols<2>(column) += cross;
    }
  }

  bool is_exit(Index k) const { return k == static_cast<Index>(shape_.T_entry_robot.size()); }
  Eigen::Block<Eigen::MatrixXd, 3, Eigen::Dynamic> rows(Index k) { return to_.to_kept.middleRows<3>(3 * (k - 1)); }
  void add_chi2(double chi2) { to_.kept(to_.kept.rows() - 1, to_.kept.cols() - 1) += chi2; }

  void add_pose(Index k, const Eigen::Matrix3d& H, const Eigen::Vector3d& b) {
    if (is_exit(k)) {
      to_.kept.topLeftCorner<3, 3>() += H;
      to_.kept.bottomRows<1>().head<3>() += b.transpose();
    } else {
      to_.diagonal[static_cast<std::size_t>(k - 1)] += H;
      rows(k).rightCols<1>() += b;
    }
  }

  PhaseEquations& to_;
  const PhaseShape& shape_;
};

}  // namespace

PhaseEquations linearise(const PhaseLog& log, const PhaseShape& shape) {
  PhaseEquations equations;
  Assembly assembly(equations, shape);
  for (const SeenLandmark& seen : log.seen_at_entry) assembly.add_observation(seen, 0);
  for (std::size_t k = 0; k < log.steps.size(); ++k) {
    const Index pose = static_cast<Index>(k) + 1;
    assembly.add_motion(log.steps[k], pose);
    for (const SeenLandmark& seen : log.steps[k].seen) assembly.add_observation(seen, pose);
  }
  if (!equations.kept.allFinite()) throw core::NumericalError("phase factor: a residual is not finite");
  return equations;
}

void eliminate_chain(PhaseEquations& equations) {
  const std::size_t poses = equations.diagonal.size();
  for (std::size_t k = 0; k < poses; ++k) {
    Eigen::Matrix3d& D = equations.diagonal[k];
    const Eigen::LLT<Eigen::Matrix3d> llt(D);
    if (llt.info() != Eigen::Success) {
      throw core::NumericalError("phase factor: pose " + std::to_string(k + 1) + " of the phase is not determined");
    }
    D = llt.matrixL();
    auto rows = equations.to_kept.middleRows<3>(3 * static_cast<Index>(k));
    D.triangularView<Eigen::Lower>().solveInPlace(rows);
    if (k + 1 == poses) break;
    Eigen::Matrix3d& E = equations.next[k];
    D.triangularView<Eigen::Lower>().solveInPlace(E);
    equations.diagonal[k + 1] -= E.transpose() * E;
    equations.to_kept.middleRows<3>(3 * static_cast<Index>(k) + 3) -= E.transpose() * rows;
  }
  if (poses == 0) return;  // one step: nothing between entry and exit; a product of zero depth divides by zero in Eigen
  equations.kept.selfadjointView<Eigen::Lower>().rankUpdate(equations.to_kept.transpose(), -1.0);
}

Eigen::VectorXd chain_step(const PhaseEquations& equations, const Eigen::VectorXd& kept_step) {
  const Index width = equations.to_kept.cols();
  Eigen::VectorXd step = equations.to_kept.rightCols<1>();
  step -= equations.to_kept.leftCols(width - 1) * kept_step;
  for (std::size_t k = equations.diagonal.size(); k-- > 0;) {
    auto own = step.segment<3>(3 * static_cast<Index>(k));
    if (k + 1 < equations.diagonal.size()) own -= equations.next[k] * step.segment<3>(3 * static_cast<Index>(k) + 3);
    equations.diagonal[k].triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  return step;
}

}  // namespace helixnav::atlas
