// SPDX-License-Identifier: BSD-3-Clause
// One event that cannot be used must not spoil the drive: whatever is refused leaves the localizer as it was, so that the
// rest of the log ends where it would have ended without it.
#include <limits>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/localization/localizer.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::localization {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<core::MapLandmark> map;
    for (const core::TrueLandmark& landmark : run_.true_landmarks) {
      core::MapLandmark& known = map.emplace_back();
      known.id = static_cast<core::LandmarkId>(landmark.label);
      known.point.mean_m = landmark.point_m;
    }
    localizer_.emplace(run_.start, map);
    undisturbed_.emplace(run_.start, map);
    for (; next_ < 200; ++next_) take(*localizer_, run_.events[next_]), take(*undisturbed_, run_.events[next_]);
    odometry_.t_ns = scan_.t_ns = core::time_of(run_.events[next_]);
    scan_.observations = {core::make_range_bearing(5.0, 0.1, 0.1, 0.01)};
    odometry_.T_before_after = core::Pose2(0.1, 0.0, 0.0);
  }

  void TearDown() override {
    for (; next_ < run_.events.size(); ++next_) {
      take(*localizer_, run_.events[next_]);
      take(*undisturbed_, run_.events[next_]);
    }
    EXPECT_EQ(localizer_->pose().mean.vector(), undisturbed_->pose().mean.vector());
    EXPECT_EQ(localizer_->pose().covariance, undisturbed_->pose().covariance);
    EXPECT_TRUE(localizer_->pose().mean.vector().allFinite());
  }

  static void take(Localizer& localizer, const core::Event& event) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) localizer.move(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) localizer.observe(*scan);
  }

  core::Recording run_ = sim::simulate(sim::named_scenario("circuit"), 7);
  std::optional<Localizer> localizer_, undisturbed_;
  std::size_t next_ = 0;
  core::Odometry odometry_;
  core::Scan scan_;
};

TEST_F(BadInput, NanInOdometryIsRefused) {
  odometry_.T_before_after.x_m = nan;
  EXPECT_THROW(localizer_->move(odometry_), core::PreconditionError);
}

TEST_F(BadInput, ACovarianceOfOdometryThatIsNoneIsRefused) {
  odometry_.covariance(0, 0) = nan;
  EXPECT_THROW(localizer_->move(odometry_), core::PreconditionError);
  odometry_.covariance(0, 0) = -1.0;
  EXPECT_THROW(localizer_->move(odometry_), core::PreconditionError);
}

TEST_F(BadInput, MotionBeyondAllNumbersIsRefused) {
  odometry_.T_before_after = core::Pose2(1e308, 1e308, 0.3);
  odometry_.covariance.diagonal().setConstant(1e300);
  localizer_->move(core::Odometry{odometry_.t_ns, {}, Eigen::Matrix3d::Zero()});
  undisturbed_->move(core::Odometry{odometry_.t_ns, {}, Eigen::Matrix3d::Zero()});
  EXPECT_ANY_THROW(localizer_->move(odometry_));
}

TEST_F(BadInput, AScanWithAnObservationThatIsNoneIsRefusedAndTheMotionBeforeItKept) {
  scan_.observations.push_back(core::make_range_bearing(-1.0, 0.1, 0.1, 0.01));
  EXPECT_THROW(localizer_->observe(scan_), core::PreconditionError);
  scan_.observations.back().z << 1.0, nan;
  EXPECT_THROW(localizer_->observe(scan_), core::PreconditionError);
  EXPECT_THROW(localizer_->observe(scan_, {core::no_landmark, core::no_landmark}), core::PreconditionError);
  scan_.observations.pop_back();
  scan_.T_robot_sensor.heading_rad = nan;
  EXPECT_THROW(localizer_->observe(scan_), core::PreconditionError);
}

TEST_F(BadInput, UpdatesThatHaveNoResultLeaveTheMotionInPlace) {
  // Two exact sightings of one landmark cannot both be weighed: S is singular.
  scan_.observations = {core::make_cartesian({5.0, 1.0}, 1e-40 * Eigen::Matrix2d::Identity()),
                        core::make_cartesian({5.0, 1.0}, 1e-40 * Eigen::Matrix2d::Identity())};
  const auto id = static_cast<core::LandmarkId>(run_.true_landmarks.front().label);
  EXPECT_THROW(localizer_->observe(scan_, {id, id}), core::NumericalError);
}

TEST_F(BadInput, AnEventBeforeTheLastOneIsRefused) {
  odometry_.t_ns -= core::nanoseconds_from_seconds(60.0);
  scan_.t_ns = odometry_.t_ns;
  EXPECT_THROW(localizer_->move(odometry_), core::PreconditionError);
  EXPECT_THROW(localizer_->observe(scan_), core::PreconditionError);
}

// Graph files leave the maximum range of the view at zero: what was not seen from there is unknown.
TEST(UnknownView, IsLocalisedInAllTheSame) {
  const core::Recording run = sim::simulate(sim::named_scenario("circuit"), 8);
  std::vector<core::MapLandmark> map;
  for (const core::TrueLandmark& landmark : run.true_landmarks) {
    core::MapLandmark& known = map.emplace_back();
    known.id = static_cast<core::LandmarkId>(landmark.label);
    known.point.mean_m = landmark.point_m;
  }
  Localizer localizer(run.start, map);
  int matched = 0;
  int observations = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) localizer.move(*odometry);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    core::Scan unbounded = *scan;
    unbounded.field_of_view = {};
    unbounded.field_of_view.max_range_m = 0.0;
    for (const core::AssociationReport& a : localizer.observe(unbounded).associations) {
      matched += a.outcome == core::Outcome::matched;
      ++observations;
    }
  }
  EXPECT_GT(matched, observations / 2);
}

}  // namespace
}  // namespace helixnav::localization
