// SPDX-License-Identifier: BSD-3-Clause
#include "placing/join_drives.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "helixnav/supervisor/join_sessions.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::supervisor {
namespace {

core::Recording loop_on(std::uint64_t day) {
  const sim::Scenario scenario = sim::named_scenario("large-loop");
  return sim::simulate_in(sim::build_world(scenario.world, 3), scenario, day);
}

core::JointMap mapped_by(const core::Recording& run) {
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  std::optional<core::JointMap> map = map_to_go_on_in(navigator, navigator.map(), 2000);
  EXPECT_TRUE(map.has_value() && map->factors != nullptr);
  return *map;
}

core::JointMap mapped_on(std::uint64_t day) { return mapped_by(loop_on(day)); }

/// A sensor that measures to half a millimetre.
core::Recording precise_loop_on(std::uint64_t day) {
  sim::Scenario scenario = sim::named_scenario("large-loop");
  scenario.true_noise.sigma_range_m = 0.0005;
  scenario.true_noise.sigma_bearing_rad = 0.00005;
  scenario.assumed_noise = scenario.true_noise;
  return sim::simulate_in(sim::build_world(scenario.world, 3), scenario, day);
}

core::JointMap without_factors(core::JointMap map) {
  map.factors = nullptr;
  return map;
}

double worst_m(const core::JointMap& one, const core::JointMap& other) {
  double worst = 0.0;
  for (std::size_t i = 0; i < one.joint.ids.size(); ++i) {
    worst = std::max(worst, (one.joint.points_m[i] - other.joint.points_m[i]).norm());
  }
  return worst;
}

/// Where nothing is bent, the solution is what was joined to first order, and the factors say the same.
TEST(JoinDrives, IsTheFirstOrderJoinWhereNothingIsBent) {
  const core::JointMap monday = mapped_on(80), tuesday = mapped_on(81);
  const JoinedSessions solved = join_sessions({monday, tuesday});
  const JoinedSessions linear = join_sessions({without_factors(monday), without_factors(tuesday)});
  ASSERT_EQ(solved.components.size(), 1u);
  ASSERT_EQ(linear.components.size(), 1u);
  const core::JointMap& map = solved.components.front();
  ASSERT_EQ(map.joint.ids, linear.components.front().joint.ids);
  EXPECT_LT(worst_m(map, linear.components.front()), 0.3);
  EXPECT_EQ(linear.components.front().factors, nullptr);
  ASSERT_NE(map.factors, nullptr);
  const core::JointGaussian joint = atlas::Atlas::from_factors(*map.factors).joint(map.joint.ids);
  EXPECT_LT((joint.covariance - map.joint.covariance).norm(), 1e-3 * map.joint.covariance.norm()) << "linearised anew";
}

TEST(JoinDrives, ASessionGoesOnInTheJoinedMapAsADrive) {
  const JoinedSessions joined = join_sessions({mapped_on(80), mapped_on(81)});
  ASSERT_EQ(joined.components.size(), 1u);
  const core::Recording today = loop_on(82);
  Navigator navigator(core::PoseGaussian{}, {});
  navigator.look_for_place_in(joined.components.front());
  std::size_t solved = 0;
  drive(today, navigator,
        [&](const core::Scan& scan, std::size_t) { solved += navigator.observe(scan).solved.size(); });
  EXPECT_GT(solved, 10u);
  EXPECT_LE(navigator.map().size(), today.true_landmarks.size() + 4);
}

/// Between the two drives nothing is known. Next to what precise ones know that vanished in rounding, and a session that had found its
/// place was refused for ever, since nothing could be solved.
TEST(JoinDrives, OfPreciseDrivesCanBeSolved) {
  const JoinedSessions joined = join_sessions({mapped_by(precise_loop_on(80)), mapped_by(precise_loop_on(81))});
  ASSERT_EQ(joined.components.size(), 1u);
  EXPECT_NE(joined.components.front().factors, nullptr);
}

TEST(JoinDrives, IsNothingWhereTheDrivesContradictEachOther) {
  const core::JointMap monday = mapped_on(80);
  const auto drive = std::make_shared<const DriveMap>(DriveMap::of_earlier(monday, 20.0));
  core::JointMap other = mapped_on(81);
  const core::LandmarkId from = monday.next_name;
  auto factors = std::make_shared<core::MapFactors>(*other.factors);
  for (auto& [id, variable] : factors->landmarks) id += from;
  for (core::LandmarkId& id : other.joint.ids) id += from;
  other.next_name += from;
  other.factors = factors;
  const DriveMap session = DriveMap::of_earlier(other, 20.0);
  JoinedMaps wrong{cekf::CompressedEkf(monday.joint, other.next_name, {}), {}, core::Pose2()};
  for (std::size_t i = 0; i < 12; ++i) {
    wrong.closing.merged.push_back({monday.joint.ids[i], other.joint.ids[(5 * i + 7) % other.joint.ids.size()]});
  }
  wrong.closing.accepted = true;
  EXPECT_FALSE(join_drives(*drive, monday.joint.ids, session, other.joint.ids, wrong, {}, {}).has_value());
}

}  // namespace
}  // namespace helixnav::supervisor
