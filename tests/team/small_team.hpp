// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/team/team.hpp"

namespace helixnav::team::testing {

/// Something that a robot reports.
struct Message {
  core::Nanoseconds t_ns = 0;
  int robot = 0;
  std::variant<core::Odometry, core::RobotSighting, core::Scan> what;
  std::vector<std::int64_t> names;
};

struct SmallTeam {
  std::vector<core::Pose2> starts;
  std::vector<Eigen::Vector2d> landmarks;
  std::vector<Message> messages;  ///< in the order that Team wants
  std::vector<core::Pose2> last;  ///< [robot] true pose at the end
};

struct SmallTeamOptions {
  int robots = 2;
  int steps = 60;      ///< of a second
  double noise = 1.0;  ///< on all sigmas below
  double drawn = 1.0;  ///< what is drawn of them; 0: measurements are exact and do not say so
  double reach_m = 8.0;
  double twin_m = 0.0;  ///< each landmark has another so far beside it; 0: none
  bool see_each_other = true;
  int slip_step = 0;  ///< before its scan of this step the first robot is displaced unnoticed; 0: never
  core::Pose2 slip;
  std::uint64_t seed = 1;
};

inline constexpr double sigma_range_m = 0.05;
inline constexpr double sigma_bearing_rad = 0.01;
inline constexpr double sigma_way_m = 0.02;
inline constexpr double sigma_turn_rad = 0.01;

/// Robots on circles side by side among 12 landmarks; every second, they see all that are within their reach.
inline SmallTeam small_team(const SmallTeamOptions& options = {}) {
  core::RandomStream random(options.seed, "small_team");
  const double k = options.noise;
  SmallTeam team;
  for (int i = 0; i < 12; ++i) {
    const double y_m = random.uniform(-6.0, 6.0);  // one after the other: the order of arguments is up to the compiler
    team.landmarks.emplace_back(random.uniform(-8.0, 8.0), y_m);
  }
  for (std::size_t i = 0; i < 12 && options.twin_m > 0.0; ++i) {
    team.landmarks.emplace_back(team.landmarks[i] + Eigen::Vector2d(options.twin_m, 0.0));
  }
  for (int r = 0; r < options.robots; ++r) team.starts.emplace_back(2.5 * r, -1.0 * r, 0.7 * r);
  team.last = team.starts;
  const auto observed = [&](const core::Pose2& from, const Eigen::Vector2d& point_m) {
    const core::ObsVector z =
        core::predict_observation(core::ObservationKind::range_bearing, from, core::Pose2(), point_m).z_hat;
    const double bearing_rad = z[1] + k * options.drawn * random.normal(0.0, sigma_bearing_rad);
    const double range_m = z[0] + k * options.drawn * random.normal(0.0, sigma_range_m);
    return core::make_range_bearing(range_m, bearing_rad, k * sigma_range_m, k * sigma_bearing_rad);
  };
  for (int step = 1; step <= options.steps; ++step) {
    const core::Nanoseconds t_ns = 1'000'000'000LL * step;
    for (int r = 0; r < options.robots; ++r) {
      const core::Pose2 true_way(0.4, 0.0, r % 2 == 0 ? 0.15 : -0.2);
      core::Odometry odometry;
      odometry.t_ns = t_ns;
      odometry.covariance =
          (k * k * Eigen::Vector3d(sigma_way_m, 0.2 * sigma_way_m, sigma_turn_rad).cwiseAbs2()).asDiagonal();
      odometry.T_before_after =
          core::Pose2(Eigen::Vector3d(true_way.vector() + options.drawn * random.normal3(odometry.covariance)));
      team.last[static_cast<std::size_t>(r)] = core::compose(team.last[static_cast<std::size_t>(r)], true_way);
      if (r == 0 && step == options.slip_step) team.last[0] = core::compose(team.last[0], options.slip);
      team.messages.push_back({t_ns, r, odometry, {}});
    }
    for (int r = 0; r < options.robots; ++r) {
      const core::Pose2& from = team.last[static_cast<std::size_t>(r)];
      for (int other = 0; other < options.robots && options.see_each_other; ++other) {
        const Eigen::Vector2d at_m = team.last[static_cast<std::size_t>(other)].position_m();
        if (other == r || (at_m - from.position_m()).norm() > options.reach_m) continue;
        team.messages.push_back({t_ns, r, core::RobotSighting{t_ns, other, core::Pose2(), observed(from, at_m)}, {}});
      }
      core::Scan scan;
      scan.t_ns = t_ns;
      std::vector<std::int64_t> names;
      for (std::size_t i = 0; i < team.landmarks.size(); ++i) {
        if ((team.landmarks[i] - from.position_m()).norm() > options.reach_m) continue;
        scan.observations.push_back(observed(from, team.landmarks[i]));
        names.push_back(static_cast<std::int64_t>(i));
      }
      team.messages.push_back({t_ns, r, scan, names});
    }
  }
  const auto key = [](const Message& m) { return std::make_tuple(m.t_ns, m.what.index(), m.robot); };
  std::stable_sort(team.messages.begin(), team.messages.end(),
                   [&](const Message& a, const Message& b) { return key(a) < key(b); });
  return team;
}

inline std::optional<core::StepReport> give(Team& team, const Message& message) {
  if (const auto* motion = std::get_if<core::Odometry>(&message.what)) return team.take(message.robot, *motion);
  if (const auto* scan = std::get_if<core::Scan>(&message.what)) return team.take(message.robot, *scan, message.names);
  team.sight(message.robot, std::get<core::RobotSighting>(message.what));
  return std::nullopt;
}

inline std::vector<std::optional<core::PoseGaussian>> known_starts(const SmallTeam& small) {
  std::vector<std::optional<core::PoseGaussian>> starts;
  for (const core::Pose2& start : small.starts) starts.push_back(core::PoseGaussian{start, Eigen::Matrix3d::Zero()});
  return starts;
}

inline std::vector<std::optional<core::PoseGaussian>> unknown_starts(const SmallTeam& small) {
  return std::vector<std::optional<core::PoseGaussian>>(small.starts.size());
}

inline Team run(const SmallTeam& small, const std::vector<std::optional<core::PoseGaussian>>& starts,
                const TeamOptions& options = {}) {
  Team team(starts, options);
  for (const Message& message : small.messages) give(team, message);
  return team;
}

inline Eigen::Vector3d difference(const core::Pose2& a, const core::Pose2& b) {
  Eigen::Vector3d d = a.vector() - b.vector();
  d[2] = core::wrap_to_pi(d[2]);
  return d;
}

}  // namespace helixnav::team::testing
