// SPDX-License-Identifier: BSD-3-Clause
#include "align_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/evaluation/alignment.hpp"

namespace helixnav::apps {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

double median_sigma_m(const std::vector<FixOnTheWay>& fixes) {
  std::vector<double> sigmas_m;
  sigmas_m.reserve(fixes.size());
  for (const FixOnTheWay& fix : fixes) sigmas_m.push_back(fix.sigma_m);
  const auto middle = sigmas_m.begin() + static_cast<std::ptrdiff_t>(sigmas_m.size() / 2);
  std::nth_element(sigmas_m.begin(), middle, sigmas_m.end());
  return *middle;
}

struct FixesAndWay {
  std::vector<Eigen::Vector2d> gps_m;
  std::vector<Eigen::Vector2d> way_m;  ///< the antenna then, dead-reckoned in the frame of the start
};

FixesAndWay points_of(const std::vector<FixOnTheWay>& fixes, const Eigen::Vector2d& antenna_robot_m) {
  FixesAndWay points;
  for (const FixOnTheWay& fix : fixes) {
    points.gps_m.push_back(fix.position_m);
    points.way_m.push_back(core::transform(fix.since_start.T_before_after, antenna_robot_m));
  }
  return points;
}

struct Agreement {
  evaluation::RigidAlignment alignment;
  double sigma_m = 0.0;  ///< the limit was four of these
};

Agreement agree_within(const FixesAndWay& points, double sigma_m) {
  return {evaluation::align_rigidly(points.gps_m, points.way_m, 4.0 * sigma_m), sigma_m};
}

/// The errors of fixes may be larger than stated, or some of the fixes may be outliers: the likelier of the two.
Agreement likeliest(const FixesAndWay& points, double stated_m) {
  constexpr int octaves = 16;
  std::vector<Agreement> all;
  for (int octave = 0; octave <= octaves; ++octave) {
    all.push_back(agree_within(points, std::ldexp(stated_m, octave)));
    if (all.back().alignment.used_count == static_cast<int>(points.gps_m.size())) break;
  }
  const auto nats = [&](const Agreement& one) {
    return 2.0 * one.alignment.used_count * std::log(all.back().sigma_m / one.sigma_m);
  };
  return *std::max_element(all.begin(), all.end(),
                           [&](const Agreement& a, const Agreement& b) { return nats(a) < nats(b); });
}

/// Of one fix, from the residuals of those that agree.
double sigma_of_residuals_m(const FixesAndWay& points, const evaluation::RigidAlignment& alignment) {
  double squares_m2 = 0.0;
  for (std::size_t i = 0; i < points.gps_m.size(); ++i) {
    if (!alignment.used[i]) continue;
    squares_m2 += (points.gps_m[i] - core::transform(alignment.T_a_b, points.way_m[i])).squaredNorm();
  }
  return std::sqrt(squares_m2 / std::max(1, 2 * alignment.used_count - 3));
}

/// With σ and the limit, which is four of it, as the residuals have them; but not below what is stated.
Agreement agree(const FixesAndWay& points, double stated_m) {
  Agreement agreement = likeliest(points, stated_m);
  constexpr int iterations = 10;
  for (int i = 0; i < iterations; ++i) {
    const double sigma_m = std::max(stated_m, sigma_of_residuals_m(points, agreement.alignment));
    const bool stays = std::abs(sigma_m - agreement.sigma_m) < 0.01 * sigma_m;
    agreement = stays ? Agreement{agreement.alignment, sigma_m} : agree_within(points, sigma_m);
    if (stays) break;
  }
  return agreement;
}

/// Errors of the pose now and of that at the start, linearised at a given start.
struct FixedPoint {
  Vector6 mean = Vector6::Zero();
  Matrix6 covariance = Matrix6::Zero();

  /// Nothing is known of the start but that it is within `far_m`.
  explicit FixedPoint(double far_m) {
    const Eigen::Matrix3d prior = Eigen::Vector3d(far_m * far_m, far_m * far_m, core::pi * core::pi).asDiagonal();
    covariance << prior, prior, prior, prior;
  }

  void predict(const core::Pose2& before, const core::Odometry& motion) {
    const core::ComposeJacobians J = core::compose_jacobians(before, motion.T_before_after);
    Matrix6 F = Matrix6::Identity();
    F.topLeftCorner<3, 3>() = J.J_first;
    mean = F * mean;
    covariance = F * covariance * F.transpose();
    covariance.topLeftCorner<3, 3>() += J.J_second * motion.covariance * J.J_second.transpose();
  }

  /// `gated_m2`: variance of the one fix, for its gate; `variance_m2`: as it is used.
  void update(const Eigen::Vector2d& innovation_m, const Eigen::Vector2d& arm_m, double gated_m2, double variance_m2) {
    static const double gate = core::chi2_quantile(0.999, 2);
    Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
    H.leftCols<3>() << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
    const Eigen::Vector2d rest_m = innovation_m - H * mean;
    const Eigen::Matrix2d predicted_m2 = H * covariance * H.transpose();
    const Eigen::Matrix2d one_m2 = predicted_m2 + gated_m2 * Eigen::Matrix2d::Identity();
    if (rest_m.dot(one_m2.inverse() * rest_m) > gate) return;
    const Eigen::Matrix2d S = predicted_m2 + variance_m2 * Eigen::Matrix2d::Identity();
    const Eigen::Matrix<double, 6, 2> K = covariance * H.transpose() * S.inverse();
    mean += K * rest_m;
    covariance -= K * S * K.transpose();
    covariance = 0.5 * (covariance + covariance.transpose()).eval();
  }
};

/// One iteration.
core::PoseGaussian smooth_start(const std::vector<FixOnTheWay>& fixes, const Eigen::Vector2d& antenna_robot_m,
                                const Agreement& agreement, const core::Pose2& linearised_at) {
  constexpr double far = 1e4;
  FixedPoint errors(far * agreement.sigma_m);
  const double wider = agreement.sigma_m / median_sigma_m(fixes);
  const double worth_one = std::max(1.0, 0.5 * agreement.alignment.used_count);
  core::Pose2 before = linearised_at;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    errors.predict(before, fixes[i].since_last);
    before = core::compose(linearised_at, fixes[i].since_start.T_before_after);
    if (!agreement.alignment.used[i]) continue;
    const Eigen::Vector2d arm_m = core::rotation(before.heading_rad) * antenna_robot_m;
    const double sigma_m = wider * fixes[i].sigma_m;
    errors.update(fixes[i].position_m - before.position_m() - arm_m, arm_m, sigma_m * sigma_m,
                  worth_one * sigma_m * sigma_m);
  }
  return {core::Pose2(linearised_at.vector() + errors.mean.tail<3>()), errors.covariance.bottomRightCorner<3, 3>()};
}

}  // namespace

AlignedStart align_start(const std::vector<FixOnTheWay>& fixes, const Eigen::Vector2d& antenna_robot_m) {
  const Agreement agreement = agree(points_of(fixes, antenna_robot_m), median_sigma_m(fixes));
  AlignedStart aligned;
  aligned.agreeing = agreement.alignment.used_count;
  aligned.fixes = static_cast<int>(fixes.size());
  aligned.start.mean = agreement.alignment.T_a_b;
  constexpr int iterations = 3;
  for (int i = 0; i < iterations; ++i) {
    aligned.start = smooth_start(fixes, antenna_robot_m, agreement, aligned.start.mean);
  }
  return aligned;
}

}  // namespace helixnav::apps
