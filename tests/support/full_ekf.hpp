// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::support {

/// Plain EKF-SLAM with one state vector (x, y, heading, x₁, y₁, …) and one covariance, both retractions; every
/// textbook matrix is written out in full. The exact counterpart of cekf::CompressedEkf, slow and clear.
class FullEkf {
 public:
  struct Sighting {
    core::LandmarkId id;
    core::Observation observation;
    core::Pose2 T_robot_sensor;
  };

  FullEkf(const core::PoseGaussian& start, bool right_invariant)
      : x(start.mean.vector()), P(start.covariance), right_invariant_(right_invariant) {}

  Eigen::VectorXd x;
  Eigen::MatrixXd P;
  std::vector<core::LandmarkId> ids;

  core::Pose2 pose() const { return core::Pose2(Eigen::Vector3d(x.head<3>())); }
  Eigen::Index row_of(core::LandmarkId id) const {
    return 3 + 2 * (std::find(ids.begin(), ids.end(), id) - ids.begin());
  }

  void predict(const core::Odometry& odometry) {
    const core::ComposeJacobians J = core::compose_jacobians(pose(), odometry.T_before_after);
    x.head<3>() = core::compose(pose(), odometry.T_before_after).vector();
    P.topRows(3) = (J.J_first * P.topRows(3)).eval();
    P.leftCols(3) = (P.leftCols(3) * J.J_first.transpose()).eval();
    P.topLeftCorner<3, 3>() += J.J_second * odometry.covariance * J.J_second.transpose();
  }

  void augment(core::LandmarkId id, const core::Observation& observation, const core::Pose2& T_robot_sensor) {
    const core::LocatedLandmark located = core::locate_landmark(observation, pose(), T_robot_sensor);
    const Eigen::Index n = x.size();
    Eigen::VectorXd longer(n + 2);
    longer << x, located.point_world_m;
    x = longer;
    P.conservativeResize(n + 2, n + 2);
    P.bottomLeftCorner(2, n) = located.G_pose * P.topLeftCorner(3, n);
    P.topRightCorner(n, 2) = P.bottomLeftCorner(2, n).transpose();
    P.bottomRightCorner<2, 2>() = located.G_pose * P.topLeftCorner<3, 3>() * located.G_pose.transpose() +
                                  located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
    ids.push_back(id);
  }

  /// New landmark whose error is G times that of (pose, landmarks in the order of `from`) plus independent noise.
  void augment(core::LandmarkId id, const Eigen::Vector2d& point_m, const std::vector<core::LandmarkId>& from,
               const Eigen::MatrixXd& G, const Eigen::Matrix2d& noise_m2) {
    const Eigen::Index n = x.size();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + 2, n);  // maps the error of this state to that of the longer one
    all.topRows(n).setIdentity();
    all.block(n, 0, 2, 3) = G.leftCols(3);
    for (std::size_t k = 0; k < from.size(); ++k) {
      all.block(n, row_of(from[k]), 2, 2) += G.middleCols(3 + 2 * static_cast<Eigen::Index>(k), 2);
    }
    P = (all * P * all.transpose()).eval();
    P.bottomRightCorner<2, 2>() += noise_m2;
    Eigen::VectorXd longer(n + 2);
    longer << x, point_m;
    x = longer;
    ids.push_back(id);
  }

  void remove(core::LandmarkId id) {
    const Eigen::Index row = row_of(id);
    std::vector<Eigen::Index> keep;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (i != row && i != row + 1) keep.push_back(i);
    }
    x = Eigen::VectorXd(x(keep));
    P = Eigen::MatrixXd(P(keep, keep));
    ids.erase(std::find(ids.begin(), ids.end(), id));
  }

  /// νᵀS⁻¹ν.
  double update(const std::vector<Sighting>& sightings) {
    const Linearised lin = linearise(sightings, x);
    const Eigen::MatrixXd S = lin.H * P * lin.H.transpose() + lin.R;
    const Eigen::MatrixXd K = P * lin.H.transpose() * S.inverse();
    correct(lin.H, lin.R, K * lin.nu);
    return lin.nu.dot(S.inverse() * lin.nu);
  }

  /// With rows about landmarks in the order of `of`, of unit noise. νᵀS⁻¹ν.
  double update(const std::vector<core::LandmarkId>& of, const Eigen::MatrixXd& rows, const Eigen::VectorXd& nu) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(nu.size(), x.size());
    for (std::size_t k = 0; k < of.size(); ++k) {
      H.middleCols<2>(row_of(of[k])) = rows.middleCols<2>(2 * static_cast<Eigen::Index>(k));
    }
    const Eigen::MatrixXd R = Eigen::MatrixXd::Identity(nu.size(), nu.size());
    const Eigen::MatrixXd S = H * P * H.transpose() + R;
    correct(H, R, P * H.transpose() * S.inverse() * nu);
    return nu.dot(S.inverse() * nu);
  }

  double update_position(const core::AbsoluteFix& fix) {
    const Linearised lin = linearise(fix);
    const Eigen::MatrixXd S = lin.H * P * lin.H.transpose() + lin.R;
    correct(lin.H, lin.R, P * lin.H.transpose() * S.inverse() * lin.nu);
    return lin.nu.dot(S.inverse() * lin.nu);
  }

  /// Minimum over δ of δᵀP⁻¹δ + |z − h(x ⊕ δ)|²_R by Gauss-Newton, without numerical refinements; then the covariance
  /// linearised at the minimum. Returns the cost there.
  double update_iterated(const std::vector<Sighting>& sightings) {
    return iterate([&](const Eigen::VectorXd& at) { return linearise(sightings, at); });
  }

  /// Conditions on first = second for each pair, difference known to sigma_m.
  double merge(const std::vector<std::pair<core::LandmarkId, core::LandmarkId>>& kept_removed, double sigma_m) {
    const double cost = iterate([&](const Eigen::VectorXd& at) {
      const Eigen::Index m = 2 * static_cast<Eigen::Index>(kept_removed.size());
      Linearised lin;
      lin.H = Eigen::MatrixXd::Zero(m, at.size());
      lin.R = sigma_m * sigma_m * Eigen::MatrixXd::Identity(m, m);
      for (Eigen::Index k = 0; k < m; k += 2) {
        const auto& [kept, removed] = kept_removed[static_cast<std::size_t>(k / 2)];
        lin.H.block(k, row_of(kept), 2, 2).setIdentity();
        lin.H.block(k, row_of(removed), 2, 2) -= Eigen::Matrix2d::Identity();
      }
      lin.nu = -lin.H * at;
      return lin;
    });
    for (const auto& pair : kept_removed) remove(pair.second);
    return cost;
  }

 private:
  struct Linearised {
    Eigen::MatrixXd H;
    Eigen::MatrixXd R;
    Eigen::VectorXd nu;
  };

  Linearised linearise(const std::vector<Sighting>& sightings, const Eigen::VectorXd& at) const {
    Eigen::Index m = 0;
    for (const Sighting& s : sightings) m += core::dimension(s.observation.kind);
    Linearised lin{Eigen::MatrixXd::Zero(m, at.size()), Eigen::MatrixXd::Zero(m, m), Eigen::VectorXd(m)};
    Eigen::Index row = 0;
    for (const Sighting& s : sightings) {
      const Eigen::Index d = core::dimension(s.observation.kind);
      const core::PredictedObservation predicted =
          core::predict_observation(s.observation.kind, core::Pose2(Eigen::Vector3d(at.head<3>())), s.T_robot_sensor,
                                    at.segment<2>(row_of(s.id)));
      lin.H.block(row, 0, d, 3) = predicted.H_pose;
      lin.H.block(row, row_of(s.id), d, 2) = predicted.H_landmark;
      lin.R.block(row, row, d, d) = s.observation.R;
      lin.nu.segment(row, d) = core::innovation(s.observation.kind, s.observation.z, predicted.z_hat);
      row += d;
    }
    return lin;
  }

  Linearised linearise(const core::AbsoluteFix& fix) const {
    Linearised lin{Eigen::MatrixXd::Zero(2, x.size()), fix.covariance_m2, Eigen::VectorXd(2)};
    const Eigen::Vector2d arm = core::rotation(x[2]) * fix.antenna_robot_m;
    lin.H.leftCols<2>().setIdentity();
    lin.H.col(2) << -arm.y(), arm.x();
    lin.nu = fix.position_world_m - (x.head<2>() + arm);
    return lin;
  }

  static Eigen::Matrix2d V(double theta) {
    Eigen::Matrix2d result = Eigen::Matrix2d::Identity();
    if (std::abs(theta) < 1e-9) return result;
    result << std::sin(theta), std::cos(theta) - 1.0, 1.0 - std::cos(theta), std::sin(theta);
    return result / theta;
  }

  bool is_point_row(Eigen::Index i) const { return i == 0 || (i >= 3 && (i - 3) % 2 == 0); }

  /// How far x ⊕ δ is from x, row by row.
  Eigen::VectorXd displacement(const Eigen::VectorXd& delta) const {
    Eigen::VectorXd moved = delta;
    if (!right_invariant_) return moved;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (is_point_row(i)) moved.segment<2>(i) = V(delta[2]) * delta.segment<2>(i);
    }
    return moved;
  }

  /// n of N = I + n·e_θᵀ, which turns errors at x into errors at x + Δ: n = J·Δp for every point.
  Eigen::VectorXd transport(const Eigen::VectorXd& moved) const {
    Eigen::VectorXd n = Eigen::VectorXd::Zero(x.size());
    if (!right_invariant_) return n;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (is_point_row(i)) n.segment<2>(i) = Eigen::Vector2d(-moved[i + 1], moved[i]);
    }
    return n;
  }

  /// Covariance of an update with H, taken at x; mean x ⊕ δ; then transport.
  void correct(const Eigen::MatrixXd& H, const Eigen::MatrixXd& R, const Eigen::VectorXd& delta) {
    const Eigen::MatrixXd S = H * P * H.transpose() + R;
    const Eigen::MatrixXd K = P * H.transpose() * S.inverse();
    P -= K * (H * P);
    const Eigen::VectorXd moved = displacement(delta);
    const Eigen::VectorXd n = transport(moved);
    x += moved;
    x[2] = core::wrap_to_pi(x[2]);
    P += n * Eigen::RowVectorXd(P.row(2));
    P += Eigen::VectorXd(P.col(2)) * n.transpose();
    P = (0.5 * (P + P.transpose())).eval();
  }

  /// ∂(x ⊕ δ)/∂δ by central differences: the oracle does not share the derivative it is to check.
  Eigen::MatrixXd retraction_jacobian(const Eigen::VectorXd& delta) const {
    Eigen::MatrixXd D(x.size(), x.size());
    const double h = 1e-6;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      Eigen::VectorXd up = delta;
      Eigen::VectorXd down = delta;
      up[j] += h;
      down[j] -= h;
      D.col(j) = (displacement(up) - displacement(down)) / (2.0 * h);
    }
    return D;
  }

  template <class Linearisation>
  double iterate(const Linearisation& linearisation) {
    Eigen::VectorXd delta = Eigen::VectorXd::Zero(x.size());
    Eigen::VectorXd lambda;
    Linearised lin;
    for (int k = 0; k < 60; ++k) {
      const Eigen::VectorXd at = x + displacement(delta);
      lin = linearisation(at);
      const Eigen::MatrixXd H = lin.H * retraction_jacobian(delta);
      const Eigen::MatrixXd S = H * P * H.transpose() + lin.R;
      lambda = S.ldlt().solve(lin.nu + H * delta);
      const Eigen::VectorXd next = P * H.transpose() * lambda;
      const double step = (next - delta).cwiseAbs().maxCoeff();
      delta = next;
      if (step < 1e-12) break;
    }
    // At the minimum R·λ is the residual.
    const Eigen::MatrixXd H = lin.H * retraction_jacobian(delta);
    const double cost = lambda.dot(H * P * H.transpose() * lambda) + lambda.dot(lin.R * lambda);
    lin.H.col(2) += lin.H * transport(displacement(delta));
    correct(lin.H, lin.R, delta);
    return cost;
  }

  bool right_invariant_;
};

}  // namespace helixnav::support
