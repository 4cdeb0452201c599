// SPDX-License-Identifier: BSD-3-Clause
// How large the default filter's error is when the large loop returns, every tree known by name.
#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "campaign.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::cekf {
namespace {

/// Maps a recording by its labels up to the scan that first shows a tree from the start again.
class UntilTheReturn {
 public:
  explicit UntilTheReturn(const core::Recording& recording) : recording_(recording), filter_(recording.start) {}

  /// Error of the predicted position there [m]; empty if the drive never comes back.
  std::optional<double> error_m() {
    std::size_t scan = 0;
    for (const core::Event& event : recording_.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) filter_.predict(*odometry);
      const auto* seen = std::get_if<core::Scan>(&event);
      if (seen == nullptr) continue;
      if (shows_an_old_tree(scan)) {
        return (filter_.pose().mean.position_m() - recording_.true_poses[scan].T_world_robot.position_m()).norm();
      }
      take(*seen, scan++);
    }
    return std::nullopt;
  }

 private:
  struct Known {
    core::LandmarkId id = core::no_landmark;
    std::size_t last_scan = 0;
  };

  bool shows_an_old_tree(std::size_t scan) const {
    constexpr std::size_t old_scans = 100;
    for (const core::Label label : recording_.labels[scan]) {
      const auto known = known_.find(label);
      if (known != known_.end() && scan - known->second.last_scan > old_scans) return true;
    }
    return false;
  }

  void take(const core::Scan& scan, std::size_t index) {
    const std::vector<core::Label>& labels = recording_.labels[index];
    std::vector<Match> matches;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto known = known_.find(labels[i]);
      if (known == known_.end()) continue;
      matches.push_back({known->second.id, scan.observations[i], scan.T_robot_sensor});
      known->second.last_scan = index;
    }
    if (!matches.empty()) filter_.update(matches);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == core::no_label || known_.count(labels[i]) > 0) continue;
      known_[labels[i]] = {filter_.augment(scan.observations[i], scan.T_robot_sensor), index};
    }
    filter_.switch_region_if_due();
  }

  const core::Recording& recording_;
  CompressedEkf filter_;
  std::map<core::Label, Known> known_;
};

// Over 1000 other seeds 63 % are beyond (median 10.7 m); the two-sided band of 80 runs at a false alarm of 1e-3 is 36 to 64.
TEST(LargeLoopCampaign, BringsAFilterThatKnowsEveryTreeBackOffByMoreThanTheSpacingOfTheTrees) {
  constexpr double spacing_m = 8.0;
  const std::vector<std::uint64_t> seeds = support::campaign_seeds(310000, 80);
  const sim::Scenario scenario = sim::named_scenario("large-loop");
  int beyond = 0;
  for (const std::uint64_t seed : seeds) {
    const std::optional<double> error_m = UntilTheReturn(sim::simulate(scenario, seed)).error_m();
    ASSERT_TRUE(error_m.has_value()) << seed;
    beyond += *error_m > spacing_m ? 1 : 0;
  }
  const support::Band band = support::count_band(static_cast<int>(seeds.size()), 0.63, 1e-3);
  EXPECT_GE(beyond, band.low);
  EXPECT_LE(beyond, band.high);
}

}  // namespace
}  // namespace helixnav::cekf
