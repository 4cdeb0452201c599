// SPDX-License-Identifier: BSD-3-Clause
// A slip on the tape: replayed, processed again and solved with the drive.
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "closing/replay_branch.hpp"
#include "helixnav/core/odometry.hpp"
#include "loop/navigation_loop.hpp"
#include "slip/update_after_slip.hpp"

namespace helixnav::supervisor {
namespace {

core::Odometry slip_of(double sigma_m, double sigma_rad) {
  core::Odometry slip;
  slip.covariance = Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
  return slip;
}

TEST(SlipOnTheTape, IsPartOfTheMotionBetweenTwoScans) {
  core::Odometry motion;
  motion.T_before_after = core::Pose2(1.0, 0.0, 0.2);
  motion.covariance = Eigen::Vector3d(1e-2, 1e-3, 1e-4).asDiagonal();
  const core::Odometry slip = slip_of(0.5, 0.05);
  Tape tape(100);
  tape.append(Tape::Motion{motion, 1.0});
  tape.append(Tape::Slip{slip});
  tape.append(Tape::Scan{});
  tape.append(Tape::Motion{motion, 1.0});
  tape.append(Tape::Slip{slip});
  const core::Odometry both = core::chain(motion, slip);
  const std::vector<Stop> stops = stops_of(tape);
  ASSERT_EQ(stops.size(), 1u);
  ASSERT_TRUE(stops[0].motion);
  EXPECT_EQ(stops[0].motion->covariance, both.covariance);
  EXPECT_LT((stops[0].motion->T_before_after.vector() - motion.T_before_after.vector()).norm(), 1e-15);
  EXPECT_EQ(motion_after_stops(tape)->covariance, both.covariance);
}

/// A filter that drives past trees with a tape beside it, and slips in the middle.
TEST(SlipOnTheTape, IsReplayedAsItWasDriven) {
  const core::Recording run = sim::simulate(wide_circuit(), 4);
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  Tape tape(100000);
  std::map<core::Label, core::LandmarkId> known;
  std::optional<Checkpoint> trigger;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      filter.predict(*odometry);
      tape.append(Tape::Motion{*odometry, 0.0});
    }
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const bool slipped = scans == 60 || scans == 200;
    if (scans == 50) {
      trigger.emplace(Checkpoint{filter.snapshot(), association::LandmarkLife(), {}, 0, tape.end(), {}});
      filter.keep_since(trigger->filter.phase);
    }
    if (slipped) {
      filter.predict(slip_of(0.7, 0.07));
      tape.append(Tape::Slip{slip_of(0.7, 0.07)});
    }
    Tape::Scan entry{*scan, {}, 0.0, 0, {}, slipped};
    for (std::size_t i = 0; i < scan->observations.size(); ++i) {
      core::AssociationReport one;
      one.observation = static_cast<int>(i);
      const auto found = known.find(run.labels[scans][i]);
      one.outcome = found != known.end() ? core::Outcome::matched : core::Outcome::augmented;
      if (found != known.end()) one.landmark = found->second;
      entry.fate.push_back(one);
    }
    std::vector<cekf::Match> matched;
    for (const core::AssociationReport& one : entry.fate) {
      if (one.outcome != core::Outcome::matched) continue;
      matched.push_back({one.landmark, scan->observations[static_cast<std::size_t>(one.observation)], {}});
      matched.back().T_robot_sensor = scan->T_robot_sensor;
    }
    slipped ? update_after_slip(filter, matched) : filter.update(matched);
    for (core::AssociationReport& one : entry.fate) {
      if (one.outcome != core::Outcome::augmented) continue;
      const auto i = static_cast<std::size_t>(one.observation);
      one.landmark = known[run.labels[scans][i]] = filter.augment(scan->observations[i], scan->T_robot_sensor);
    }
    tape.append(entry);
    ++scans;
    if (scans < run.labels.size()) filter.switch_region_if_due();
  }
  cekf::CompressedEkf again = filter;
  replay_branch(again, {*trigger, tape}, {});
  EXPECT_LT((again.pose().mean.vector() - filter.pose().mean.vector()).norm(), 1e-8);
  EXPECT_LT((again.pose().covariance - filter.pose().covariance).cwiseAbs().maxCoeff(), 1e-8);
  for (const auto& [label, id] : known) {
    EXPECT_LT((again.landmark_mean(id) - filter.landmark_mean(id)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace helixnav::supervisor
