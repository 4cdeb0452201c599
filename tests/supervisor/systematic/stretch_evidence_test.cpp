// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/stretch_evidence.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "helixnav/core/odometry.hpp"
#include "helixnav/sim/simulate.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "labelled_drive.hpp"
#include "systematic/least_squares_twin.hpp"
#include "systematic/with_errors.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t stops_a_stretch = 20;

/// Every third scan of a drive whose associations are known.
std::vector<Stop> stops_of_drive(const core::Recording& recording) {
  const LabelledDrive drive(recording, false);
  std::vector<Stop> chosen;
  std::optional<core::Odometry> motion;
  std::size_t k = 0;
  for (const Stop& stop : stops_of(drive.tape)) {
    if (stop.motion) motion = motion ? core::chain(*motion, *stop.motion) : *stop.motion;
    if (k++ % 3 != 0) continue;
    chosen.push_back(stop);
    chosen.back().motion = motion;
    motion.reset();
  }
  return chosen;
}

std::vector<Stop> stretch(const std::vector<Stop>& stops, std::size_t first) {
  std::vector<Stop> some(stops.begin() + static_cast<std::ptrdiff_t>(first),
                         stops.begin() + static_cast<std::ptrdiff_t>(first + stops_a_stretch));
  some.front().motion.reset();
  return some;
}

core::Recording simulated(std::uint64_t seed) {
  const sim::Scenario scenario;
  return sim::simulate(scenario, seed);
}

TEST(StretchEvidence, IsThatOfLeastSquaresOverAllPosesAndLandmarks) {
  SystematicErrors errors;
  errors.too_long = 0.02;
  errors.short_m = 0.1;
  const std::vector<Stop> stops = stops_of_drive(with_errors(simulated(1), errors));
  for (const std::size_t first : {0u, 40u, 80u}) {
    const std::vector<Stop> some = stretch(stops, first);
    const auto evidence = evidence_of_stretch(some);
    ASSERT_TRUE(evidence);
    smoothing::Problem problem = problem_of(some);
    const double chi2 = smoothing::optimize(problem).chi2.total();
    const auto twin = smoothing::evidence_of_constants(problem, constants_of(problem, some));
    EXPECT_NEAR(evidence->chi2, chi2, 1e-3 * chi2);
    EXPECT_EQ(evidence->dof, smoothing::degrees_of_freedom(problem));
    const Eigen::VectorXd unit = twin.information.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((unit.asDiagonal() * (evidence->information - twin.information) * unit.asDiagonal()).norm(), 0.01);
    EXPECT_LT((unit.cwiseProduct(evidence->gradient + twin.gradient)).norm(), 0.02);  // in standard deviations
  }
}

/// gᵀ Λ⁻¹ g of errors that are not there has the χ² distribution; at constant speed, turning per second and per metre are one.
TEST(StretchEvidence, OfNoErrorsIsAsChanceHasIt) {
  double sum = 0.0, dof = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Stop> stops = stops_of_drive(simulated(seed));
    for (std::size_t first = 0; first + stops_a_stretch <= stops.size(); first += stops_a_stretch) {
      const auto evidence = evidence_of_stretch(stretch(stops, first));
      if (!evidence) continue;
      const std::array<Eigen::Index, 4> chosen = {0, 1, 3, 4};
      const Eigen::Matrix4d information = evidence->information(chosen, chosen);
      const Eigen::Vector4d gradient = evidence->gradient(chosen);
      const Eigen::LLT<Eigen::Matrix4d> factor(information);
      if (factor.info() != Eigen::Success) continue;
      sum += gradient.dot(factor.solve(gradient));
      dof += 4.0;
    }
  }
  ASSERT_GT(dof, 250.0);
  EXPECT_NEAR(sum, dof, 3.3 * std::sqrt(2.0 * dof));  // outside in 1 of 1000
}

/// Points seen in a narrow view, uncertain across the line of sight: a derivative along the measured line would have the sign of its
/// residual, and every stretch would find ranges too long.
TEST(StretchEvidence, PointsInANarrowViewShowNoRangeOffset) {
  sim::Scenario scenario;
  scenario.scanner.field_of_view = {1.0, 30.0, -0.5, 0.5};
  scenario.true_noise.sigma_bearing_rad = scenario.assumed_noise.sigma_bearing_rad = 0.03;
  double gradient = 0.0, information = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    core::Recording run = sim::simulate(scenario, seed);
    for (core::Event& event : run.events) {
      auto* scan = std::get_if<core::Scan>(&event);
      if (scan == nullptr) continue;
      for (core::Observation& seen : scan->observations) {
        const auto point = core::locate_landmark(seen, {}, {});
        seen = core::make_cartesian(point.point_world_m, point.G_z * Eigen::Matrix2d(seen.R) * point.G_z.transpose());
      }
    }
    const std::vector<Stop> stops = stops_of_drive(run);
    for (std::size_t first = 0; first + stops_a_stretch <= stops.size(); first += stops_a_stretch) {
      const auto evidence = evidence_of_stretch(stretch(stops, first));
      if (!evidence) continue;
      gradient += evidence->gradient(4);
      information += evidence->information(4, 4);
    }
  }
  EXPECT_LT(std::abs(gradient), 3.3 * std::sqrt(information));  // outside in 1 of 1000
}

TEST(StretchEvidence, NeedsLandmarksSeenTwice) {
  std::vector<Stop> stops = stretch(stops_of_drive(simulated(1)), 0);
  for (Stop& stop : stops) stop.seen.clear();
  EXPECT_FALSE(evidence_of_stretch(stops));
  EXPECT_FALSE(evidence_of_stretch({}));
}

}  // namespace
}  // namespace helixnav::supervisor
