// SPDX-License-Identifier: BSD-3-Clause
#include "moving/track.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double moving_gate = 18.4;    // χ²₂ of 1 − 10⁻⁴
constexpr double standing_gate = 50.0;  // what is too far off to be matched is nearer to no other landmark
constexpr double steady_s = 5.0;        // a velocity is forgotten over this time

double density(const Eigen::Vector2d& nu, const Eigen::Matrix2d& S, double gate) {
  const Eigen::LLT<Eigen::Matrix2d> llt(S);
  const double nis = llt.matrixL().solve(nu).squaredNorm();
  if (!(nis < gate)) return 0.0;
  return std::exp(-0.5 * nis) / (2.0 * core::pi * llt.matrixL().toDenseMatrix().diagonal().prod());
}

/// Jacobian of a point with respect to the vehicle's motion (x, y, heading), in the frame after it.
Eigen::Matrix<double, 2, 3> by_motion(const Eigen::Matrix2d& R_after_before, const Eigen::Vector2d& point_m) {
  Eigen::Matrix<double, 2, 3> J;
  J << -R_after_before, Eigen::Vector2d(point_m.y(), -point_m.x());
  return J;
}

}  // namespace

Track::Track(core::LandmarkId landmark, const SeenPoint& seen, core::Nanoseconds t_ns, double sigma_mps)
    : x_(seen.point_m.x(), seen.point_m.y(), 0.0, 0.0),
      P_(Eigen::Matrix4d::Zero()),
      stands_m_(seen.point_m),
      stands_covariance_m2_(seen.covariance_m2),
      t_ns_(t_ns),
      sigma_mps_(sigma_mps),
      landmarks_{landmark} {
  P_.topLeftCorner<2, 2>() = seen.covariance_m2;
  P_.bottomRightCorner<2, 2>() = sigma_mps * sigma_mps * Eigen::Matrix2d::Identity();
}

void Track::change_frame(const core::Odometry& motion) {
  const core::Pose2 T_after_before = core::inverse(motion.T_before_after);
  const Eigen::Matrix2d R = core::rotation(T_after_before.heading_rad);
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() = R;
  x_.head<2>() = core::transform(T_after_before, Eigen::Vector2d(x_.head<2>()));
  x_.tail<2>() = (R * x_.tail<2>()).eval();
  stands_m_ = core::transform(T_after_before, stands_m_);
  const Eigen::Matrix<double, 2, 3> J = by_motion(R, x_.head<2>());
  const Eigen::Matrix<double, 2, 3> J_stands = by_motion(R, stands_m_);
  P_ = (turn * P_ * turn.transpose()).eval();
  P_.topLeftCorner<2, 2>() += J * motion.covariance * J.transpose();
  stands_covariance_m2_ =
      R * stands_covariance_m2_ * R.transpose() + J_stands * motion.covariance * J_stands.transpose();
}

void Track::predict(core::Nanoseconds t_ns) {
  const double dt_s = core::seconds(t_ns - std::exchange(t_ns_, t_ns));
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.topRightCorner<2, 2>() = dt_s * Eigen::Matrix2d::Identity();
  x_ = (F * x_).eval();
  P_ = (F * P_ * F.transpose()).eval();
  const double sigma_mps = sigma_mps_ * dt_s / steady_s;
  P_.bottomRightCorner<2, 2>() += sigma_mps * sigma_mps * Eigen::Matrix2d::Identity();
}

double Track::density_if_moving(const SeenPoint& seen) const {
  return density(seen.point_m - x_.head<2>(), P_.topLeftCorner<2, 2>() + seen.covariance_m2, moving_gate);
}

double Track::density_if_standing(const SeenPoint& seen) const {
  return density(seen.point_m - stands_m_, stands_covariance_m2_ + seen.covariance_m2, standing_gate);
}

void Track::see_standing(const SeenPoint& seen, double nats) {
  const double if_moving = density_if_moving(seen);
  const Eigen::Vector2d stands_m = stands_m_;
  const Eigen::Matrix2d covariance_m2 = stands_covariance_m2_;
  if (if_moving > 0.0) {
    see_moving(seen, nats);
  } else {
    nats_ += nats;
    misses_in_a_row_ = 0;
  }
  const Eigen::Matrix2d K = covariance_m2 * (covariance_m2 + seen.covariance_m2).inverse();
  stands_m_ = stands_m + K * (seen.point_m - stands_m);
  stands_covariance_m2_ = covariance_m2 - K * covariance_m2;
  was_seen_again_ = true;
}

void Track::see_moving(const SeenPoint& seen, double nats) {
  const Eigen::Matrix2d S = P_.topLeftCorner<2, 2>() + seen.covariance_m2;
  const Eigen::Matrix<double, 4, 2> K = P_.leftCols<2>() * S.inverse();
  x_ += K * (seen.point_m - x_.head<2>());
  P_ = (P_ - K * S * K.transpose()).eval();
  stands_m_ = seen.point_m;
  stands_covariance_m2_ = seen.covariance_m2;
  nats_ += nats;
  misses_in_a_row_ = 0;
  was_seen_again_ = false;
}

std::vector<core::LandmarkId> Track::take_landmarks() { return std::exchange(landmarks_, {}); }

}  // namespace helixnav::supervisor
