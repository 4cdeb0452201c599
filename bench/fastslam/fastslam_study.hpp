// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <time.h>

#include "helixnav/core/recording.hpp"
#include "helixnav/evaluation/alignment.hpp"
#include "helixnav/fastslam/fast_slam.hpp"

/// Shared by the experiments on FastSLAM: drives with names, scores, intervals.
namespace helixnav::bench {

struct StudySettings {
  std::string data = "../shared/data";
  int runs = 0;               ///< 0: as many as documented for the figure
  std::size_t particles = 0;  ///< likewise
  unsigned threads = 1;
};

/// One line of a table: a filter with its association.
struct Method {
  std::string name;
  bool kalman = false;  ///< the compressed EKF instead
  fastslam::Proposal proposal = fastslam::Proposal::motion_and_scan;
  fastslam::Association association = fastslam::Association::likelihood_ratio;
  bool exclusive = true;
  bool weigh_unseen = true;
  bool split_always = false;
  bool ambiguous_zone = true;

  fastslam::Options options(fastslam::Options base) const {
    base.proposal = proposal;
    base.association = association;
    base.exclusive = exclusive;
    base.weigh_unseen = weigh_unseen;
    base.hypotheses.split_always = split_always;
    if (!ambiguous_zone) base.new_gate = base.match_gate;
    return base;
  }
  bool known() const { return association == fastslam::Association::known; }
};

/// A scan of a simulated drive with the odometry before it, whose truth is known.
struct DrivenScan {
  std::size_t robot = 0;
  core::Odometry odometry;
  core::Scan scan;
  std::vector<fastslam::KnownName> names;  ///< no_name: clutter
  core::Pose2 truth;
};

inline core::StepReport step(fastslam::FastSlam& slam, const DrivenScan& driven, bool known) {
  slam.predict(driven.odometry, driven.robot);
  return known ? slam.update_known(driven.scan, driven.names, driven.robot) : slam.update(driven.scan, driven.robot);
}

inline double processor_us() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// "98/100 [93, 99] %": a share with its Wilson 95 % interval.
inline std::string share(int k, int n) {
  const double z = 1.96, p = static_cast<double>(k) / n, down = 1.0 + z * z / n;
  const double centre = (p + z * z / (2.0 * n)) / down;
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / down;
  char text[64];
  std::snprintf(text, sizeof text, "%d/%d [%.0f, %.0f] %%", k, n, 100.0 * std::max(0.0, centre - half),
                100.0 * std::min(1.0, centre + half));
  return text;
}

inline double mean(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return v.empty() ? std::nan("") : sum / static_cast<double>(v.size());
}
inline double quantile(std::vector<double> v, double share_below) {
  if (v.empty()) return std::nan("");
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(share_below * static_cast<double>(v.size() - 1))];
}

/// Constant speed and turn rate for `duration_s`, with white noise of both held over it.
inline core::Odometry unicycle(double speed_mps, double turn_radps, double duration_s, double sigma_speed,
                               double sigma_turn) {
  const double a = turn_radps * duration_s, d = speed_mps * duration_s;
  const double along = std::abs(a) < 1e-9 ? 1.0 : std::sin(a) / a,
               beside = std::abs(a) < 1e-9 ? a / 2 : (1 - std::cos(a)) / a;
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(d * along, d * beside, a);
  Eigen::Matrix<double, 3, 2> J;
  J << duration_s * along, -d * duration_s * a / 3.0, duration_s * beside, d * duration_s / 2.0, 0.0, duration_s;
  const Eigen::Vector2d variance(sigma_speed * sigma_speed, sigma_turn * sigma_turn);
  odometry.covariance = J * variance.asDiagonal() * J.transpose();
  return odometry;
}

struct TimedPose {
  core::Nanoseconds t_ns = 0;
  core::Pose2 T_world_robot;
};

/// Positions of the antenna against fixes within `limit_m` after a rigid alignment.
struct PathScore {
  double rmse_m = 0.0, median_m = 0.0;
  std::size_t used = 0, beyond = 0;
  core::Pose2 T_truth_map;
};

inline PathScore score_path(const std::vector<TimedPose>& path, const core::Recording& recording,
                            double limit_m = 10.0) {
  std::vector<Eigen::Vector2d> fixes, antenna;
  std::size_t k = 0;
  for (const core::TruePosition& fix : recording.true_positions) {
    if (path.size() < 2 || fix.t_ns < path.front().t_ns || fix.t_ns > path.back().t_ns) continue;
    while (k + 2 < path.size() && path[k + 1].t_ns < fix.t_ns) ++k;
    const TimedPose &a = path[k], &b = path[k + 1];
    const double w =
        b.t_ns > a.t_ns ? static_cast<double>(fix.t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns) : 0.0;
    const core::Pose2 at(
        a.T_world_robot.x_m + w * (b.T_world_robot.x_m - a.T_world_robot.x_m),
        a.T_world_robot.y_m + w * (b.T_world_robot.y_m - a.T_world_robot.y_m),
        a.T_world_robot.heading_rad + w * core::wrap_to_pi(b.T_world_robot.heading_rad - a.T_world_robot.heading_rad));
    fixes.push_back(fix.position_m);
    antenna.push_back(core::transform(at, recording.antenna_robot_m));
  }
  const evaluation::RigidAlignment alignment = evaluation::align_rigidly(fixes, antenna, limit_m);
  PathScore score;
  score.T_truth_map = alignment.T_a_b;
  std::vector<double> errors;
  double squares = 0.0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const double e = (fixes[i] - core::transform(score.T_truth_map, antenna[i])).norm();
    if (e > limit_m) {
      ++score.beyond;
      continue;
    }
    errors.push_back(e);
    squares += e * e;
  }
  score.used = errors.size();
  score.rmse_m = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, errors.size())));
  score.median_m = quantile(errors, 0.5);
  return score;
}

int run_pair(const StudySettings& settings, bool one_return);
int run_four(const StudySettings& settings);
int run_robots(const StudySettings& settings,
               const std::string& only);  ///< only: one method by its name; empty: all, and the EKF
int run_car_park(const StudySettings& settings, bool known);
int run_victoria_park(const StudySettings& settings, double until_s, const std::string& which);
int run_consistency(const StudySettings& settings);

}  // namespace helixnav::bench
