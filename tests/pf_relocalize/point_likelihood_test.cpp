// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/point_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::pf_relocalize {
namespace {

/// One row of THEORY §3.1's table.
struct Case {
  const char* name;
  double sigma_range_m, sigma_bearing_rad;
  double least_map_sigma_m, most_map_sigma_m;
  double least_range_m, most_range_m;
  double linearised_median, linearised_most;  // |Δ log p| of the closed form, with room of a factor two
};

const double degree = core::pi / 180.0;
const std::vector<Case> table{
    {"laser, map 0.1-0.5 m", 0.1, 1.0 * degree, 0.1, 0.5, 2.0, 40.0, 1.2e-2, 0.45},
    {"laser, map 0.5-2 m", 0.1, 1.0 * degree, 0.5, 2.0, 2.0, 40.0, 4e-3, 0.035},
    {"laser, map 2-5 m", 0.1, 1.0 * degree, 2.0, 5.0, 2.0, 20.0, 1e-3, 0.01},
    {"bearing 10 deg, map 0.2-1 m", 0.3, 10.0 * degree, 0.2, 1.0, 5.0, 40.0, 0.4, 30.0},
    {"map 0.01-0.03 m", 0.1, 1.0 * degree, 0.01, 0.03, 5.0, 40.0, 8e-3, 1.0},
};

struct Sample {
  core::Observation observation;
  core::Pose2 pose;
  core::PointGaussian landmark;
};

/// Two draws, y first, as when the figures of the table were drawn: the compiler may evaluate arguments in any order.
template <class Draw>
Eigen::Vector2d two(const Draw& draw) {
  const double y = draw();
  return {draw(), y};
}

Sample draw(const Case& row, core::RandomStream& random) {
  Sample sample;
  const double heading_rad = random.uniform(-3.0, 3.0);
  const Eigen::Vector2d at_m = two([&] { return random.uniform(-5.0, 5.0); });
  sample.pose = core::Pose2(at_m.x(), at_m.y(), heading_rad);
  const Eigen::Matrix2d Q = core::rotation(random.uniform(-3.0, 3.0));
  const Eigen::Vector2d sigma = two([&] { return random.uniform(row.least_map_sigma_m, row.most_map_sigma_m); });
  sample.landmark.covariance_m2 = Q * sigma.cwiseAbs2().asDiagonal() * Q.transpose();
  const double range = random.uniform(row.least_range_m, row.most_range_m), bearing = random.uniform(-1.5, 1.5);
  const Eigen::Vector2d seen =
      core::transform(sample.pose, range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)));
  const Eigen::Vector2d error = two([&] { return random.normal(); });
  sample.landmark.mean_m = seen + 1.5 * Q * sigma.cwiseProduct(error);
  const Eigen::Vector2d noise = two([&] { return random.normal(); });
  sample.observation =
      core::make_range_bearing(range + row.sigma_range_m * noise.x(), bearing + row.sigma_bearing_rad * noise.y(),
                               row.sigma_range_m, row.sigma_bearing_rad);
  return sample;
}

/// Eq (9) by the trapezoidal rule in the noise of the observation, ±8 σ: spectrally accurate for this integrand.
double log_quadrature(const Sample& sample, int nodes) {
  const double step = 16.0 / (nodes - 1);
  const Eigen::Vector2d sigma = sample.observation.R.diagonal().cwiseSqrt();
  const Eigen::Matrix2d W = sample.landmark.covariance_m2.inverse();
  const double norm = std::sqrt(W.determinant()) / (2.0 * core::pi);
  double sum = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const double gi = -8.0 + i * step, r = sample.observation.z[0] + sigma[0] * gi;
    if (r <= 0.0) continue;
    for (int j = 0; j < nodes; ++j) {
      const double gj = -8.0 + j * step, angle = sample.pose.heading_rad + sample.observation.z[1] + sigma[1] * gj;
      const Eigen::Vector2d d =
          sample.pose.position_m() + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)) - sample.landmark.mean_m;
      sum += r * norm * std::exp(-0.5 * (d.dot(W * d) + gi * gi + gj * gj));
    }
  }
  return std::log(sum * step * step / (2.0 * core::pi));
}

/// Dense enough for the narrowest of map and noise: a map of 1 cm under 0.7 m of arc noise.
int nodes_for(const Case& row) { return row.most_map_sigma_m < 0.05 ? 1201 : 241; }

struct Errors {
  std::vector<double> linearised, order3, order5;
};

Errors errors_of(const Case& row, int runs) {
  core::RandomStream random(31, row.name);
  Errors errors;
  for (int run = 0; run < runs; ++run) {
    const Sample s = draw(row, random);
    const double exact = log_quadrature(s, nodes_for(row));
    if (exact < std::log(1e-12)) continue;
    const core::Pose2 at_robot;
    errors.linearised.push_back(
        std::abs(log_likelihood_linearised(s.observation, s.pose, at_robot, s.landmark) - exact));
    errors.order3.push_back(
        std::abs(log_likelihood_gauss_hermite(s.observation, s.pose, at_robot, s.landmark, 3) - exact));
    errors.order5.push_back(
        std::abs(log_likelihood_gauss_hermite(s.observation, s.pose, at_robot, s.landmark, 5) - exact));
  }
  for (auto* column : {&errors.linearised, &errors.order3, &errors.order5}) std::sort(column->begin(), column->end());
  return errors;
}

TEST(PointLikelihood, GaussHermiteIsWithinAThousandthOfQuadratureAndTheClosedFormAsGoodAsTheTableSays) {
  for (const Case& row : table) {
    const Errors errors = errors_of(row, row.most_map_sigma_m < 0.05 ? 5 : 50);
    ASSERT_GE(errors.order5.size(), 5U) << row.name;
    EXPECT_LE(errors.order5.back(), 1e-3) << row.name;
    EXPECT_LE(errors.order3[errors.order3.size() / 2], 1e-3) << row.name;
    EXPECT_LE(errors.linearised[errors.linearised.size() / 2], row.linearised_median) << row.name;
    EXPECT_LE(errors.linearised.back(), row.linearised_most) << row.name;
  }
}

TEST(PointLikelihood, IsADensityOverObservations) {
  // ∫ p(z|x) dz over range and bearing is 1: the Jacobian r belongs to the density.
  const core::PointGaussian landmark{{6.0, 2.0}, (Eigen::Matrix2d() << 0.2, 0.05, 0.05, 0.1).finished()};
  const core::Pose2 pose(0.5, -0.5, 0.3);
  double linearised = 0.0, gauss_hermite = 0.0;
  const double dr = 0.1, db = 0.02;
  for (double r = 2.0; r < 11.0; r += dr) {
    for (double b = -1.0; b < 1.2; b += db) {
      const core::Observation z = core::make_range_bearing(r, b, 0.2, 0.05);
      linearised += dr * db * std::exp(log_likelihood_linearised(z, pose, {}, landmark));
      gauss_hermite += dr * db * std::exp(log_likelihood_gauss_hermite(z, pose, {}, landmark));
    }
  }
  EXPECT_NEAR(gauss_hermite, 1.0, 1e-3);
  EXPECT_NEAR(linearised, 1.0, 2e-2);
}

TEST(PointLikelihood, KnowsTheLeverArmAndIsExactForCartesianObservations) {
  const core::PointGaussian landmark{{6.0, 2.0}, (Eigen::Matrix2d() << 0.2, 0.05, 0.05, 0.1).finished()};
  const core::Pose2 T_world_robot(0.5, -0.5, 0.3), T_robot_sensor(3.78, 0.5, 0.2);
  const core::Observation z = core::make_range_bearing(3.0, 0.1, 0.1, 0.02);
  const core::Pose2 T_world_sensor = core::compose(T_world_robot, T_robot_sensor);
  EXPECT_NEAR(log_likelihood_gauss_hermite(z, T_world_robot, T_robot_sensor, landmark),
              log_likelihood_gauss_hermite(z, T_world_sensor, {}, landmark), 1e-12);
  const core::Observation c = core::make_cartesian({3.0, 0.2}, 0.01 * Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d S = landmark.covariance_m2 + 0.01 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d d = core::transform(T_world_sensor, {3.0, 0.2}) - landmark.mean_m;
  const double exact = -0.5 * d.dot(S.inverse() * d) - std::log(2.0 * core::pi) - 0.5 * std::log(S.determinant());
  EXPECT_NEAR(log_likelihood_linearised(c, T_world_robot, T_robot_sensor, landmark), exact, 1e-12);
  EXPECT_NEAR(log_likelihood_gauss_hermite(c, T_world_robot, T_robot_sensor, landmark), exact, 1e-12);
}

TEST(PointLikelihood, RefusesOneRowKindsAndUnknownOrders) {
  const core::PointGaussian landmark{{6.0, 2.0}, Eigen::Matrix2d::Identity()};
  EXPECT_THROW(log_likelihood_linearised(core::make_bearing(0.1, 0.01), {}, {}, landmark), core::PreconditionError);
  EXPECT_THROW(log_likelihood_gauss_hermite(core::make_range_bearing(3, 0, 0.1, 0.1), {}, {}, landmark, 4),
               core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
