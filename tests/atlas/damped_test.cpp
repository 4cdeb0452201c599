// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "atlas_access.hpp"
#include "campaign.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "solve/damped.hpp"

namespace helixnav::atlas {
namespace {

/// A road in a circle of 16 km, a landmark each 8 m on both sides, driven without a fix: it comes back with an error of a hundred metres.
class LongRoad {
 public:
  explicit LongRoad(std::uint64_t seed) : random_(seed) {}

  long steps() const { return k_; }
  /// 2·(observations − landmarks): degrees of freedom that measurements have beyond what they determine.
  int dof() const { return 2 * (observations_ - static_cast<int>(landmarks_.size())); }

  /// The clone where it ends.
  int add_phase(Atlas& atlas) {
    auto log = std::make_shared<PhaseLog>();
    for (int i = 0; i < 9; ++i) log->steps.push_back(step());
    return atlas.add(derive_factor(*log, dead_reckon(*log)), log) + 1;
  }
  void fix(Atlas& atlas, int clone, const core::Pose2& T_map_world = {}) {
    core::AbsoluteFix fix;
    fix.covariance_m2.setIdentity();
    fix.position_world_m = core::transform(T_map_world, pose(k_).position_m()) +
                           Eigen::Vector2d(random_.normal(0.0, 1.0), random_.normal(0.0, 1.0));
    atlas.fix(clone, fix);
  }
  Eigen::Vector2d position_m() const { return pose(k_).position_m(); }
  double error_m(const Atlas& atlas) const { return (atlas.pose().position_m() - pose(k_).position_m()).norm(); }

  static constexpr long steps_a_lap = 8000;

 private:
  static constexpr long count = 4000;
  static constexpr double radius_m = 4.0 * count / (2.0 * core::pi);

  static core::Pose2 pose(long k) {
    const double angle_rad = 2.0 * static_cast<double>(k) / radius_m;
    return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), core::wrap_to_pi(angle_rad)};
  }
  static Eigen::Vector2d landmark(long i) {
    const double angle_rad = (4.0 * static_cast<double>(i - i % 2) + 2.0) / radius_m;
    const double r_m = radius_m + (i % 2 == 0 ? -6.0 : 6.0);
    return {r_m * std::sin(angle_rad), radius_m - r_m * std::cos(angle_rad)};
  }

  LoggedStep step() {
    ++k_;
    LoggedStep step;
    step.covariance = Eigen::Vector3d(0.02, 0.01, 5e-4).cwiseAbs2().asDiagonal();
    step.T_before_after =
        core::Pose2(Eigen::Vector3d(core::between(pose(k_ - 1), pose(k_)).vector() + random_.normal3(step.covariance)));
    for (long i = k_ / 2 - 8; i <= k_ / 2 + 8; ++i) {
      const long name = (i + count) % count;
      const Eigen::Vector2d seen_m = core::transform(core::inverse(pose(k_)), landmark(name));
      if (seen_m.norm() > 25.0) continue;
      const Eigen::Vector2d noise_m(random_.normal(0.0, 0.1), random_.normal(0.0, 0.1));
      step.seen.push_back({static_cast<core::LandmarkId>(name), core::Pose2(),
                           core::make_cartesian(seen_m + noise_m, 0.01 * Eigen::Matrix2d::Identity())});
      landmarks_.insert(name);
      ++observations_;
    }
    return step;
  }

  core::RandomStream random_;
  long k_ = 0;
  int observations_ = 0;
  std::set<long> landmarks_;
};

TEST(DampedCampaign, ManyPhasesOnOldGroundAtOnceAreSolvedAfterAnyDrift) {
  for (const std::uint64_t seed : support::campaign_seeds(2, 3)) {  // the ordinary way does not find 2 and 4
    LongRoad road(seed);
    Atlas atlas;
    int waiting = 0;
    while (road.steps() < LongRoad::steps_a_lap - 60) {
      road.add_phase(atlas);
      if (++waiting % 26 == 0) atlas.settle();
    }
    atlas.settle();
    EXPECT_GT(road.error_m(atlas), 20.0) << seed;
    for (int phase = 0; phase < 26; ++phase) road.add_phase(atlas);
    ASSERT_NO_THROW(atlas.settle()) << seed;
    EXPECT_TRUE(atlas.is_settled());
    EXPECT_LT(road.error_m(atlas), 2.0) << seed;
    EXPECT_NEAR(atlas.chi2(), road.dof(), 4.5 * std::sqrt(2.0 * road.dof())) << seed;  // leaves with probability 1e-5
  }
}

TEST(Damped, SeesWhatAFixThatCameWhereTheMapIsFarOffPulls) {
  LongRoad road(1);
  core::PoseGaussian start;
  start.covariance = Eigen::Vector3d(0.01, 0.01, 0.2).cwiseAbs2().asDiagonal();
  Atlas atlas(start);
  int clone = 0;
  while (road.steps() < 500) clone = road.add_phase(atlas);
  atlas.settle();
  const core::Pose2 T_true_turned(0.0, 0.0, 0.1);  // the drive of a kilometre began with a heading wrong by so much
  road.fix(atlas, clone, T_true_turned);
  State state = AtlasAccess::working(atlas);
  int redone = 0;
  ASSERT_NO_THROW(damp(state, redone)) << "what it was added with is not what it can have at least";
  atlas.settle();
  EXPECT_LT((atlas.pose().position_m() - core::transform(T_true_turned, road.position_m())).norm(), 5.0);
}

}  // namespace
}  // namespace helixnav::atlas
