// SPDX-License-Identifier: BSD-3-Clause
// Every refusal leaves the filter byte for byte as it was, and names the landmark.
#include <limits>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "random_program.hpp"
#include "same_bytes.hpp"

namespace helixnav::cekf {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class BadInput : public testing::TestWithParam<Retraction> {
 protected:
  void SetUp() override {
    for (int k = 0; k < 150; ++k) program_.step();
    for (const core::LandmarkId id : filter_.landmarks()) (filter_.is_active(id) ? active_ : passive_) = id;
    ASSERT_NE(active_, core::no_landmark);
    ASSERT_NE(passive_, core::no_landmark);
    before_ = bytes_of(filter_);
  }

  template <class Error, class Call>
  void expect_refused(const Call& call, const std::string& named = {}) {
    try {
      call();
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
    EXPECT_TRUE(bytes_of(filter_) == before_);
  }

  RandomProgram program_{31, {GetParam(), 220, 40, false}};
  CompressedEkf& filter_ = program_.filter;
  core::LandmarkId active_ = core::no_landmark;
  core::LandmarkId passive_ = core::no_landmark;
  std::string before_;
};

TEST_P(BadInput, AnInnovationCovarianceThatIsNotPositiveDefiniteIsANumericalError) {
  const core::Observation exact = core::make_cartesian({5.0, 1.0}, 1e-40 * Eigen::Matrix2d::Identity());
  for (const core::LandmarkId id : {active_, passive_}) {
    const std::vector<Match> twice = {{id, exact, {}}, {id, exact, {}}};
    expect_refused<core::NumericalError>([&] { filter_.update(twice); }, std::to_string(id));
    expect_refused<core::NumericalError>([&] { filter_.update_iterated(twice); }, std::to_string(id));
  }
}

TEST_P(BadInput, NanInAnObservationIsRefused) {
  core::Observation z = core::make_range_bearing(5.0, nan, 0.1, 0.01);
  expect_refused<core::PreconditionError>([&] { filter_.update({{passive_, z, {}}}); }, std::to_string(passive_));
  expect_refused<core::PreconditionError>([&] { filter_.update_iterated({{passive_, z, {}}}); });
  expect_refused<core::PreconditionError>([&] { filter_.augment(z, {}); });
}

TEST_P(BadInput, ADerivedPointThatIsIncompleteOrNotFiniteIsRefusedBeforeAnythingIsActivated) {
  DerivedPoint good;
  good.ids = {passive_};
  good.G = Eigen::MatrixXd::Ones(2, 5);
  DerivedPoint bad = good;
  bad.ids = {passive_, 99999};
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "99999");
  bad = good;
  bad.G = Eigen::MatrixXd::Ones(2, 7);
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "derived point");
  bad = good;
  bad.G(1, 4) = nan;
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "derived point");
  bad = good;
  bad.point_m.x() = nan;
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "derived point");
  bad = good;
  bad.noise_m2 << 1.0, 0.0, 0.0, -1e-3;
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "derived point");
  bad.noise_m2 << 1.0, 0.5, 0.0, 1.0;
  expect_refused<core::PreconditionError>([&] { filter_.augment(bad); }, "derived point");
  EXPECT_FALSE(filter_.is_active(passive_));
  EXPECT_NO_THROW(filter_.augment(good));
}

TEST_P(BadInput, RowsAboutPointsThatDoNotFitAreRefusedBeforeAnythingIsActivated) {
  PointRows good;
  good.ids = {passive_};
  good.H = Eigen::MatrixXd::Ones(3, 2);
  good.nu = Eigen::Vector3d::Zero();
  PointRows bad = good;
  bad.ids = {99999};
  expect_refused<core::PreconditionError>([&] { filter_.update(bad); }, "99999");
  bad = good;
  bad.ids = {passive_, passive_};
  bad.H = Eigen::MatrixXd::Ones(3, 4);
  expect_refused<core::PreconditionError>([&] { filter_.update(bad); }, "each landmark once");
  bad = good;
  bad.H = Eigen::MatrixXd::Ones(3, 3);
  expect_refused<core::PreconditionError>([&] { filter_.update(bad); }, "rows");
  bad = good;
  bad.H(1, 1) = nan;
  expect_refused<core::PreconditionError>([&] { filter_.update(bad); }, "rows");
  bad = good;
  bad.nu[2] = nan;
  expect_refused<core::PreconditionError>([&] { filter_.update(bad); }, "rows");
  EXPECT_FALSE(filter_.is_active(passive_));
  EXPECT_NO_THROW(filter_.update(good));
}

TEST_P(BadInput, ANoiseCovarianceThatIsNotPositiveDefiniteIsRefused) {
  core::Observation z = core::make_range_bearing(5.0, 0.1, 0.1, 0.01);
  z.R(1, 1) = -1e-4;
  expect_refused<core::PreconditionError>([&] { filter_.update({{active_, z, {}}}); }, std::to_string(active_));
  z.R << 1.0, 2.0, 0.0, 1.0;
  expect_refused<core::PreconditionError>([&] { filter_.update({{active_, z, {}}}); });
  core::Odometry odometry;
  odometry.covariance(0, 0) = -1.0;
  expect_refused<core::PreconditionError>([&] { filter_.predict(odometry); });
  odometry.covariance.setZero();
  odometry.T_before_after.x_m = nan;
  expect_refused<core::PreconditionError>([&] { filter_.predict(odometry); });
  core::AbsoluteFix fix;
  fix.covariance_m2(0, 0) = -1.0;
  expect_refused<core::PreconditionError>([&] { filter_.update_position(fix); });
}

TEST_P(BadInput, AnUnknownOrRemovedLandmarkIsRefusedByName) {
  const core::Observation z = core::make_range_bearing(5.0, 0.1, 0.1, 0.01);
  const std::vector<core::LandmarkId> known = filter_.landmarks();
  core::LandmarkId removed = 0;
  while (filter_.contains(removed)) ++removed;
  for (const core::LandmarkId id : {removed, 100000, -3}) {
    const std::string name = std::to_string(id);
    expect_refused<core::PreconditionError>([&] { filter_.update({{passive_, z, {}}, {id, z, {}}}); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.remove(id); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.activate(id); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.merge(active_, id); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.landmark(id); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.joint({active_, id}); }, name);
    expect_refused<core::PreconditionError>([&] { filter_.switch_region({id}); }, name);
  }
}

TEST_P(BadInput, AMergeThatContradictsItselfIsRefused) {
  expect_refused<core::PreconditionError>([&] { filter_.merge(active_, active_); });
  expect_refused<core::PreconditionError>([&] { filter_.merge({{active_, passive_}, {passive_, active_}}); });
}

TEST_P(BadInput, ABearingAloneDoesNotBeginALandmark) {
  expect_refused<core::PreconditionError>([&] { filter_.augment(core::make_bearing(0.1, 0.01), {}); });
}

TEST_P(BadInput, ABearingBeyondATurnIsRefused) {
  const core::Observation z = core::make_range_bearing(5.0, 7.0, 0.1, 0.01);
  expect_refused<core::PreconditionError>([&] { filter_.update({{active_, z, {}}}); }, std::to_string(active_));
}

TEST_P(BadInput, MotionBeyondAllNumbersIsRefusedWithItsTime) {
  core::Odometry odometry;
  odometry.t_ns = 4711;
  odometry.T_before_after = core::Pose2(1e308, 1e308, 0.0);
  expect_refused<core::PreconditionError>([&] { filter_.predict(odometry); }, "t_ns = 4711");
  odometry.T_before_after = core::Pose2();
  odometry.covariance.diagonal().setConstant(1e300);
  expect_refused<core::PreconditionError>([&] { filter_.predict(odometry); }, "4711");
}

TEST_P(BadInput, TheLastOfAllNamesIsNotGiven) {
  const core::Observation z = core::make_range_bearing(5.0, 0.1, 0.1, 0.01);
  const core::LandmarkId last = std::numeric_limits<core::LandmarkId>::max();
  expect_refused<core::PreconditionError>([&] { filter_.augment(z, {}, last); });
}

// Steps of 1e6 m from a broken encoder: the filter refuses them or keeps a valid covariance, but goes on either way.
TEST_P(BadInput, AbsurdStepsNeverLeaveANegativeVariance) {
  core::Odometry odometry;
  odometry.covariance = Eigen::Vector3d(1.0, 1.0, 1e-2).asDiagonal();
  for (int k = 0; k < 40; ++k) {
    odometry.T_before_after = core::Pose2(k % 2 == 0 ? 1e6 : -1e6, 3.0, 0.1);
    const core::Observation z = core::make_range_bearing(5.0, 0.1, 0.1, 0.01);
    try {
      filter_.predict(odometry);
      filter_.update({{k % 3 == 0 ? passive_ : active_, z, {}}});
      filter_.switch_region_if_due();
    } catch (const core::NumericalError&) {
    }
    const Eigen::VectorXd variances = filter_.joint(filter_.landmarks()).covariance.diagonal();
    ASSERT_TRUE(variances.allFinite()) << k;
    ASSERT_GE(filter_.pose().covariance.diagonal().minCoeff(), -1e-18) << k;
  }
}

TEST_P(BadInput, ARadiusWithoutBoundHoldsTheWholeMap) {
  const Eigen::Vector2d here_m = filter_.pose().mean.position_m();
  for (const double radius_m : {1e9, 1e11, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(filter_.landmarks_within(here_m, radius_m), filter_.landmarks()) << radius_m;
  }
  EXPECT_TRUE(filter_.landmarks_within({1e12, -1e12}, 10.0).empty());
  expect_refused<core::PreconditionError>([&] { filter_.landmarks_within(here_m, nan); });
  expect_refused<core::PreconditionError>([&] { filter_.landmarks_within({nan, 0.0}, 1.0); });
}

TEST(Start, MayBeExactlyKnownButNotIndefinite) {
  EXPECT_NO_THROW(CompressedEkf(core::PoseGaussian{}));
  core::PoseGaussian start;
  start.covariance(0, 0) = -1.0;
  EXPECT_THROW(CompressedEkf{start}, core::PreconditionError);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, BadInput, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
