// SPDX-License-Identifier: BSD-3-Clause
// Every verb, once for each of its allocations with that one failing: the object is then byte for byte what it was, and
// the verb, called again, gives the same result as without a failure.
#include <functional>
#include <new>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "failing_malloc.hpp"
#include "helixnav/localization/localizer.hpp"
#include "helixnav/sim/simulate.hpp"
#include "random_program.hpp"
#include "same_bytes.hpp"

#ifdef HELIXNAV_CAN_FAIL_MALLOC

namespace helixnav {
namespace {

/// Points of failure tried.
template <class Object, class Call, class Bytes>
int fail_each_allocation(Object& object, const Call& call, const Bytes& bytes) {
  const std::string before = bytes(object);
  for (int count = 1; count < 100000; ++count) {
    testing::fail_allocation(count);
    try {
      call(object);
      testing::fail_allocation(0);
      return count - 1;
    } catch (const std::bad_alloc&) {
      testing::fail_allocation(0);
    }
    const bool same = bytes(object) == before;
    EXPECT_TRUE(same) << "allocation " << count;
    if (!same) return count;
  }
  return 0;
}

using cekf::CompressedEkf;

std::string all_bytes(const CompressedEkf& filter) { return cekf::bytes_of(filter); }

class FailedAllocation : public ::testing::TestWithParam<cekf::Retraction> {
 protected:
  void SetUp() override {
    for (int k = 0; k < 150; ++k) program_.step();
    for (const core::LandmarkId id : filter_.landmarks()) (filter_.is_active(id) ? active_ : passive_).push_back(id);
    ASSERT_GE(active_.size(), 3u);
    ASSERT_GE(passive_.size(), 6u);
  }

  /// Requires at least `least` allocations, so that the test is known to test something.
  void expect_unharmed(const std::function<void(CompressedEkf&)>& verb, int least) {
    CompressedEkf undisturbed = filter_;
    verb(undisturbed);  // now owns its passive covariance, if the verb writes it
    const int failed = fail_each_allocation(filter_, verb, all_bytes);
    EXPECT_GE(failed, least);
    EXPECT_TRUE(all_bytes(filter_) == all_bytes(undisturbed));
    for (CompressedEkf* const each : {&filter_, &undisturbed}) {
      each->augment(near_, {});
      each->switch_region();
      each->augment(near_, {});
      each->switch_region();
    }
    EXPECT_TRUE(all_bytes(filter_) == all_bytes(undisturbed)) << "some time later";
  }

  cekf::Match seen(core::LandmarkId id) const {
    const core::PredictedObservation p = core::predict_observation(core::ObservationKind::range_bearing,
                                                                   filter_.pose().mean, {}, filter_.landmark_mean(id));
    return {id, core::make_range_bearing(p.z_hat[0] + 0.05, p.z_hat[1] - 0.01, 0.3, 0.05), {}};
  }

  cekf::RandomProgram program_{31, {GetParam(), 220, 40, false}};
  CompressedEkf& filter_ = program_.filter;
  core::Observation near_ = core::make_range_bearing(6.0, 0.4, 0.2, 0.02);
  std::vector<core::LandmarkId> active_;
  std::vector<core::LandmarkId> passive_;
};

TEST_P(FailedAllocation, LeavesPredictAlone) {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(0.1, 0.0, 0.01);
  odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  expect_unharmed([&](CompressedEkf& f) { f.predict(odometry); }, 0);
}

TEST_P(FailedAllocation, LeavesAnUpdateThatActivates) {
  const std::vector<cekf::Match> matches = {seen(active_[0]), seen(passive_[0]), seen(active_[1]), seen(passive_[1])};
  expect_unharmed([&](CompressedEkf& f) { f.update(matches); }, 10);
}

TEST_P(FailedAllocation, LeavesAnIteratedUpdate) {
  const std::vector<cekf::Match> matches = {seen(active_[0]), seen(passive_[0])};
  expect_unharmed([&](CompressedEkf& f) { f.update_iterated(matches); }, 10);
}

TEST_P(FailedAllocation, LeavesAFix) {
  core::AbsoluteFix fix;
  fix.position_world_m = filter_.pose().mean.position_m();
  expect_unharmed([&](CompressedEkf& f) { f.update_position(fix); }, 0);
}

TEST_P(FailedAllocation, LeavesABirth) {
  expect_unharmed([&](CompressedEkf& f) { f.augment(near_, {}); }, 0);
  const core::LandmarkId far_name = filter_.next_name() + 500;
  expect_unharmed([&](CompressedEkf& f) { f.augment(near_, {}, far_name); }, 1);
}

TEST_P(FailedAllocation, LeavesADerivedPoint) {
  cekf::DerivedPoint point;
  point.ids = {passive_[0], active_[0], passive_[1]};
  point.G = 0.2 * Eigen::MatrixXd::Ones(2, 9);
  point.noise_m2.setIdentity();
  expect_unharmed([&](CompressedEkf& f) { f.augment(point); }, 10);
}

TEST_P(FailedAllocation, LeavesAMerge) {
  const std::vector<CompressedEkf::LandmarkPair> pairs = {{active_[0], passive_[0]}, {passive_[1], active_[1]}};
  expect_unharmed([&](CompressedEkf& f) { f.merge(pairs, 50.0); }, 10);
}

TEST_P(FailedAllocation, LeavesARemoval) {
  expect_unharmed([&](CompressedEkf& f) { f.remove(passive_[0]); }, 0);
  expect_unharmed([&](CompressedEkf& f) { f.remove(active_[0]); }, 0);
}

TEST_P(FailedAllocation, LeavesAnActivation) {
  expect_unharmed([&](CompressedEkf& f) { f.activate(passive_[2]); }, 4);
}

TEST_P(FailedAllocation, LeavesASwitchThatAbsorbs) {
  filter_.augment(near_, {});
  filter_.remove(passive_[3]);
  const std::vector<core::LandmarkId> wanted = {passive_[0], active_[0], passive_[1]};
  expect_unharmed([&](CompressedEkf& f) { f.switch_region(wanted); }, 20);
}

TEST_P(FailedAllocation, LeavesASwitchThatKeepsThePhase) {
  filter_.keep_since(filter_.phase());
  filter_.augment(near_, {});
  filter_.switch_region();
  const std::vector<core::LandmarkId> wanted = {passive_[0], active_[0], passive_[1]};
  expect_unharmed([&](CompressedEkf& f) { f.switch_region(wanted); }, 20);
}

TEST_P(FailedAllocation, LeavesASwitchFromTheWholeMap) {
  filter_.switch_region(filter_.landmarks());
  filter_.augment(near_, {});
  filter_.remove(passive_[3]);
  filter_.keep_since(filter_.phase());
  const cekf::Snapshot snapshot = filter_.snapshot();
  const std::vector<core::LandmarkId> wanted = {passive_[0], active_[0], passive_[1]};
  expect_unharmed([&](CompressedEkf& f) { f.switch_region(wanted); }, 20);
  EXPECT_TRUE(filter_.can_restore(snapshot));
}

TEST_P(FailedAllocation, LeavesARestoreAcrossPhases) {
  filter_.activate(passive_[4]);
  const cekf::Snapshot snapshot = filter_.snapshot();
  filter_.keep_since(filter_.phase());
  filter_.augment(near_, {});
  filter_.activate(passive_[5]);
  filter_.switch_region({passive_[0]});
  filter_.augment(near_, {});
  filter_.switch_region();
  expect_unharmed([&](CompressedEkf& f) { f.restore(snapshot); }, 5);
}

TEST_P(FailedAllocation, LeavesThePhasesThatWereToBeAbsorbed) {
  const cekf::Snapshot snapshot = filter_.snapshot();
  filter_.keep_since(filter_.phase());
  for (int k = 0; k < 3; ++k) {
    filter_.augment(near_, {});
    filter_.switch_region();
  }
  const auto with_reach = [&](const CompressedEkf& f) { return all_bytes(f) + (f.can_restore(snapshot) ? "y" : "n"); };
  const long now = filter_.phase();
  EXPECT_GE(fail_each_allocation(
                filter_, [&](CompressedEkf& f) { f.keep_since(now); }, with_reach),
            3);  // room for a phase's two factors, and a covariance of its own
  EXPECT_FALSE(filter_.can_restore(snapshot));
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, FailedAllocation,
                         ::testing::Values(cekf::Retraction::standard, cekf::Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == cekf::Retraction::standard ? "Standard" : "RightInvariant";
                         });

TEST(FailedAllocationInLocalizer, LeavesThePoseAndTheMotionBeforeTheScan) {
  const core::Recording run = sim::simulate(sim::named_scenario("circuit"), 9);
  std::vector<core::MapLandmark> map;
  for (const core::TrueLandmark& landmark : run.true_landmarks) {
    core::MapLandmark& known = map.emplace_back();
    known.id = static_cast<core::LandmarkId>(landmark.label);
    known.point.mean_m = landmark.point_m;
  }
  localization::Localizer disturbed(run.start, map);
  localization::Localizer undisturbed(run.start, map);
  const auto bytes = [](const localization::Localizer& localizer) {
    const core::PoseGaussian pose = localizer.pose();
    return std::string(reinterpret_cast<const char*>(pose.covariance.data()), 72) +
           std::string(reinterpret_cast<const char*>(pose.mean.vector().data()), 24);
  };
  int failed = 0;
  for (std::size_t k = 0; k < 120; ++k) {
    const auto take = [&](localization::Localizer& localizer) {
      if (const auto* odometry = std::get_if<core::Odometry>(&run.events[k])) localizer.move(*odometry);
      if (const auto* scan = std::get_if<core::Scan>(&run.events[k])) localizer.observe(*scan);
    };
    take(undisturbed);
    failed += fail_each_allocation(disturbed, take, bytes);
    ASSERT_TRUE(bytes(disturbed) == bytes(undisturbed)) << k;
  }
  EXPECT_GT(failed, 100);
}

}  // namespace
}  // namespace helixnav

#endif
