// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/closing_evidence.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/sim/simulate.hpp"
#include "labelled_drive.hpp"
#include "systematic/least_squares_twin.hpp"
#include "systematic/with_errors.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double sensor_reach_m = 30.0;

/// Two laps round a circuit, the trees of the second lap mapped anew and merged at its end.
core::Recording two_laps(std::uint64_t seed) { return sim::simulate(sim::named_scenario("two-laps"), seed); }

SystematicErrors turning(double rad_per_s) {
  SystematicErrors errors;
  errors.turn_rad_per_s = rad_per_s;
  return errors;
}

std::vector<core::Pose2> poses_at(const std::vector<Stop>& stops, const std::vector<core::StampedPose>& path) {
  std::vector<core::Pose2> poses;
  std::size_t next = 0;
  for (const Stop& stop : stops) {
    while (path.at(next).t_ns != stop.t_ns) ++next;
    poses.push_back(path[next].T_world_robot);
  }
  return poses;
}

struct OfConstants {
  double chi2;
  smoothing::ConstantsEvidence says;
};

OfConstants least_squares(const std::vector<Stop>& stops, const std::vector<core::StampedPose>& path) {
  smoothing::Problem problem = problem_of(stops, poses_at(stops, path));
  const double chi2 = smoothing::optimize(problem).chi2.total();
  return {chi2, smoothing::evidence_of_constants(problem, constants_of(problem, stops))};
}

std::vector<Stop> with_names_now(std::vector<Stop> stops, const Tape& tape) {
  const core::MergedIds ids = merged_ids(tape);
  for (Stop& stop : stops) {
    for (cekf::Match& match : stop.seen) match.landmark = ids.now(match.landmark);
  }
  return stops;
}

TEST(ClosingEvidence, IsWhatMergingAddsToLeastSquares) {
  const core::Recording run = with_errors(two_laps(1), turning(0.01));
  LabelledDrive drive(run, true);
  const std::vector<core::StampedPose> path = drive.solve().path;
  const auto evidence = evidence_of_closing(drive.tape, path, sensor_reach_m);
  ASSERT_TRUE(evidence);
  const std::vector<Stop> used = stops_of_closing(drive.tape, sensor_reach_m);
  const OfConstants with = least_squares(with_names_now(used, drive.tape), path);
  const OfConstants without = least_squares(used, path);
  EXPECT_NEAR(evidence->chi2, with.chi2 - without.chi2, 0.02 * (with.chi2 - without.chi2));
  const Eigen::MatrixXd information = with.says.information - without.says.information;
  const Eigen::VectorXd gradient = without.says.gradient - with.says.gradient;
  for (const Eigen::Index i : {0, 1, 2}) {  // of odometry
    EXPECT_NEAR(evidence->information(i, i), information(i, i), 0.02 * information(i, i));
    EXPECT_NEAR(evidence->gradient(i), gradient(i), 0.05 * std::sqrt(information(i, i)));
  }
}

/// The sum of eight squared errors, in standard deviations, is below 0.86 or above 26.1 twice in a thousand times.
TEST(ClosingEvidence, HasTheTurnBiasOfTheLoop) {
  double squares = 0.0, information = 0.0, gradient = 0.0;
  const double bias = 0.008;
  for (std::uint64_t seed = 2; seed <= 9; ++seed) {
    const core::Recording run = with_errors(two_laps(seed), turning(bias));
    LabelledDrive drive(run, true);
    const auto evidence = evidence_of_closing(drive.tape, drive.solve().path, sensor_reach_m);
    ASSERT_TRUE(evidence);
    const double by_sigma = (evidence->gradient(1) - evidence->information(1, 1) * bias);
    squares += by_sigma * by_sigma / evidence->information(1, 1);
    information += evidence->information(1, 1);
    gradient += evidence->gradient(1);
  }
  EXPECT_GT(squares, 0.86);
  EXPECT_LT(squares, 26.1);
  EXPECT_GT(gradient / std::sqrt(information), 2.0) << "eight loops have it by two standard deviations";
}

TEST(ClosingEvidence, IsNothingWithoutAClosingOrTheDrive) {
  const core::Recording run = two_laps(8);
  EXPECT_FALSE(evidence_of_closing(LabelledDrive(run, false).tape, {}, sensor_reach_m)) << "nothing was merged";
  LabelledDrive closed(run, true);
  EXPECT_FALSE(evidence_of_closing(closed.tape, {}, 0.5))
      << "some two hundred scans are farther apart than a quarter of a metre";
  closed.tape.drop_drive();
  EXPECT_FALSE(evidence_of_closing(closed.tape, {}, sensor_reach_m));
}

}  // namespace
}  // namespace helixnav::supervisor
