// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/systematic_errors.hpp"

#include <gtest/gtest.h>

#include "central_differences.hpp"

namespace helixnav::supervisor {
namespace {

using Vector = SystematicErrors::Vector;

core::Odometry curved_increment() {
  core::Odometry odometry = core::Odometry();
  odometry.T_before_after = {1.2, 0.1, 0.2};
  return odometry;
}

TEST(SystematicErrors, DerivativeOfAMotionIsThatOfCentralDifferences) {
  constexpr double seconds = 0.7;
  const auto taken_out = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return without(SystematicErrors(Vector(e)), curved_increment(), {seconds, 0.0}).T_before_after.vector();
  };
  const Eigen::MatrixXd J = testing::central_differences(taken_out, Vector::Zero());
  EXPECT_LT((J - derivative_without_errors(curved_increment().T_before_after, seconds)).norm(), 1e-8);
}

/// The innovation of an observation with the errors taken out, of a landmark seen by a sensor aside of the vehicle's origin.
class InnovationOf {
 public:
  explicit InnovationOf(const core::Observation& seen) {
    scan_.T_robot_sensor = {3.0, 0.5, 0.3};
    scan_.observations = {seen};
  }

  Eigen::VectorXd operator()(const Eigen::VectorXd& e) const {
    const core::Scan scan = without(SystematicErrors(Vector(e)), scan_);
    const core::Observation& seen = scan.observations.front();
    const auto predicted = core::predict_observation(seen.kind, {10.0, 5.0, 0.4}, scan.T_robot_sensor, {20.0, 17.0});
    return core::innovation(seen.kind, seen.z, predicted.z_hat);
  }

  /// The same observation without an innovation, where the derivatives are those wanted.
  static core::Observation seen_as_predicted(core::Observation seen) {
    seen.z = core::predict_observation(seen.kind, {10.0, 5.0, 0.4}, {3.0, 0.5, 0.3}, {20.0, 17.0}).z_hat;
    return seen;
  }

 private:
  core::Scan scan_;
};

TEST(SystematicErrors, DerivativeOfAnObservationIsThatOfCentralDifferences) {
  for (const core::Observation& kind :
       {core::make_range_bearing(1.0, 0.0, 0.1, 0.01), core::make_cartesian({1.0, 0.0}, Eigen::Matrix2d::Identity())}) {
    const core::Observation seen = InnovationOf::seen_as_predicted(kind);
    const Eigen::MatrixXd J = testing::central_differences(InnovationOf(seen), Vector::Zero());
    EXPECT_LT((J - derivative_without_errors(seen)).norm(), 1e-7);
  }
}

TEST(SystematicErrors, TakenOutOneAfterTheOtherIsTakenOutTogether) {
  const Vector first = (Vector() << 0.03, 0.01, 0.002, 0.02, 0.1).finished();
  const Vector then = (Vector() << -0.01, 0.003, -0.001, 0.01, -0.02).finished();
  const SystematicErrors sum = both(SystematicErrors(first), SystematicErrors(then));
  const core::Odometry once = without(sum, curved_increment(), {0.5, 0.0});
  const core::Odometry twice =
      without(SystematicErrors(then), without(SystematicErrors(first), curved_increment(), {0.5, 0.0}), {0.5, 0.0});
  // A turn per metre is of metres as they were measured: of second order.
  EXPECT_LT((once.T_before_after.vector() - twice.T_before_after.vector()).norm(), 1e-4);
  core::Scan scan;
  scan.observations = {core::make_range_bearing(4.0, 0.5, 0.1, 0.01)};
  const core::Scan at_once = without(sum, scan);
  const core::Scan in_turn = without(SystematicErrors(then), without(SystematicErrors(first), scan));
  EXPECT_NEAR(at_once.observations[0].z(0), in_turn.observations[0].z(0), 1e-12);
  EXPECT_NEAR(at_once.T_robot_sensor.heading_rad, in_turn.T_robot_sensor.heading_rad, 1e-12);
}

TEST(SystematicErrors, RangesStayPositive) {
  SystematicErrors errors;
  errors.short_m = -1.0;
  core::Scan scan;
  scan.observations = {core::make_range_bearing(0.4, 0.0, 0.1, 0.01),
                       core::make_cartesian({0.3, 0.4}, Eigen::Matrix2d::Identity()), core::make_bearing(0.1, 0.01)};
  const core::Scan shortened = without(errors, scan);
  EXPECT_EQ(shortened.observations[0].z(0), 0.2);
  EXPECT_NEAR(shortened.observations[1].z.norm(), 0.25, 1e-12);
  EXPECT_EQ(shortened.observations[2].z(0), 0.1);
}

}  // namespace
}  // namespace helixnav::supervisor
