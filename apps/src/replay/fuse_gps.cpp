// SPDX-License-Identifier: BSD-3-Clause
#include "fuse_gps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "align_start.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/interpolate.hpp"
#include "helixnav/core/odometry.hpp"
#include "truth_of_fused.hpp"

namespace helixnav::apps {
namespace {

/// Increments across a fix become two, so that it is used at the vehicle's place then. An increment whose start no event gives
/// stays whole.
void split_at_fixes(core::Recording& recording) {
  std::vector<core::Event> events;
  events.reserve(recording.events.size() + recording.true_positions.size());
  auto fix = recording.true_positions.begin();
  for (core::Event& event : recording.events) {
    auto* odometry = std::get_if<core::Odometry>(&event);
    while (odometry != nullptr && !events.empty()) {
      const core::Nanoseconds begin_ns = core::time_of(events.back());
      while (fix != recording.true_positions.end() && fix->t_ns <= begin_ns) ++fix;
      if (fix == recording.true_positions.end() || fix->t_ns >= odometry->t_ns) break;
      const double fraction = core::seconds(fix->t_ns - begin_ns) / core::seconds(odometry->t_ns - begin_ns);
      const auto [driven, rest] = core::split(*odometry, fraction, fix->t_ns);
      events.emplace_back(driven);
      *odometry = rest;
    }
    events.push_back(std::move(event));
  }
  recording.events = std::move(events);
}

double sigma_of(const core::TruePosition& fix, const GpsSettings& settings) {
  return fix.sigma_m > 0.0 ? fix.sigma_m : settings.sigma_m;
}

/// The way since the first fix, as a chain of chords of at least a tenth of the length asked for: the noise of the poses of a parked vehicle
/// is no way.
class DrivenWay {
 public:
  explicit DrivenWay(double asked_m) : asked_m_(asked_m) {}

  void go_to(const Eigen::Vector2d& position_m) {
    const double chord_m = (position_m - corner_m_).norm();
    farthest_m_ = std::max(farthest_m_, position_m.norm());
    last_chord_m_ = chord_m;
    if (chord_m < chord_share * asked_m_) return;
    chords_m_ += chord_m;
    last_chord_m_ = 0.0;
    corner_m_ = position_m;
  }

  double length_m() const { return chords_m_ + last_chord_m_; }
  double farthest_m() const { return farthest_m_; }

 private:
  static constexpr double chord_share = 0.1;
  double asked_m_;
  double chords_m_ = 0.0;
  double last_chord_m_ = 0.0;
  double farthest_m_ = 0.0;
  Eigen::Vector2d corner_m_ = Eigen::Vector2d::Zero();
};

/// An EKF is consistent with a heading known to a degree or two (Bailey et al., IROS 2006): what comes after is better fused.
constexpr double sure_heading_rad = 2.0 * core::pi / 180.0;

/// The first fixes, one by one, until they align the start.
class Beginning {
 public:
  Beginning(const GpsSettings& settings, const Eigen::Vector2d& antenna_robot_m)
      : settings_(settings), antenna_robot_m_(antenna_robot_m), way_(settings.start_m) {}

  void move(const core::Odometry& motion) { since_last_ = core::chain(since_last_, motion); }

  /// True once the start is aligned.
  bool take(const core::TruePosition& fix) {
    since_start_ = core::chain(since_start_, since_last_);
    fixes_.push_back({fix.position_m, sigma_of(fix, settings_), since_last_, since_start_});
    since_last_ = core::no_motion(fix.t_ns);
    if (fixes_.size() == 1) first_m_ = since_start_.T_before_after.position_m();
    way_.go_to(since_start_.T_before_after.position_m() - first_m_);
    if (!may_be_enough()) return false;
    aligned_ = align_start(fixes_, antenna_robot_m_);
    next_size_ = fixes_.size() + fixes_.size() / 10 + 1;
    return is_enough();
  }

  /// Of as many fixes as there are. InputError if they leave the start open.
  const AlignedStart& last_resort(const std::string& name);

  const AlignedStart& aligned() const { return aligned_; }

 private:
  bool is_long() const { return way_.length_m() >= settings_.start_m; }

  /// Without an alignment, which costs time.
  bool may_be_enough() const {
    if (fixes_.size() < next_size_) return false;
    return is_long() || way_.farthest_m() * sure_heading_rad > fixes_.back().sigma_m;
  }

  bool is_enough() const {
    constexpr double most_starts = 3.0;  // where no majority agrees, the largest group does
    constexpr int least = 5;             // beyond the two that fit any path
    const bool is_majority = 2 * aligned_.agreeing > aligned_.fixes;
    const bool is_sure =
        aligned_.agreeing >= least && aligned_.start.covariance(2, 2) < sure_heading_rad * sure_heading_rad;
    return (is_majority && (is_sure || is_long())) || way_.length_m() >= most_starts * settings_.start_m;
  }

  const GpsSettings& settings_;
  Eigen::Vector2d antenna_robot_m_;
  DrivenWay way_;
  core::Odometry since_last_ = core::no_motion(0);
  core::Odometry since_start_ = core::no_motion(0);
  std::vector<FixOnTheWay> fixes_;
  Eigen::Vector2d first_m_ = Eigen::Vector2d::Zero();  ///< where the first fix was taken: the way before says nothing
  std::size_t next_size_ = 2;
  AlignedStart aligned_;
};

const AlignedStart& Beginning::last_resort(const std::string& name) {
  if (fixes_.size() < 2) {
    throw core::InputError(
        name +
        ": --gps fuse aligns the start to the first fixes, and this log has only one, which does not tell "
        "the heading: choose --gps truth");
  }
  if (!is_long()) {
    throw core::InputError(name + ": --gps fuse aligns the start to the fixes of gps.start_m = " +
                           std::to_string(std::lround(settings_.start_m)) + " m of driving, and this log has " +
                           std::to_string(fixes_.size()) + " fixes on " + std::to_string(std::lround(way_.length_m())) +
                           " m from the first one on: choose a smaller gps.start_m or --gps truth");
  }
  aligned_ = align_start(fixes_, antenna_robot_m_);
  return aligned_;
}

AlignedStart begin(const core::Recording& recording, const GpsSettings& settings) {
  Beginning beginning(settings, recording.antenna_robot_m);
  std::size_t event = 0;
  for (const core::TruePosition& fix : recording.true_positions) {
    for (; event < recording.events.size() && core::time_of(recording.events[event]) <= fix.t_ns; ++event) {
      const auto* odometry = std::get_if<core::Odometry>(&recording.events[event]);
      if (odometry != nullptr) beginning.move(*odometry);
    }
    if (beginning.take(fix)) return beginning.aligned();
  }
  return beginning.last_resort(recording.name);
}

}  // namespace

void fuse_gps(core::Recording& recording, const GpsSettings& settings) {
  if (recording.true_positions.empty()) throw core::InputError(recording.name + ": --gps fuse needs a log with GPS");
  split_at_fixes(recording);
  const AlignedStart beginning = begin(recording, settings);
  recording.start = beginning.start;

  std::vector<core::Event> events;
  events.reserve(recording.events.size() + recording.true_positions.size());
  std::size_t event = 0;
  for (auto i = static_cast<std::size_t>(beginning.fixes); i < recording.true_positions.size(); ++i) {
    core::AbsoluteFix fix;
    fix.t_ns = recording.true_positions[i].t_ns;
    fix.position_world_m = recording.true_positions[i].position_m;
    const double sigma_m = sigma_of(recording.true_positions[i], settings);
    fix.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
    fix.antenna_robot_m = recording.antenna_robot_m;
    for (; event < recording.events.size() && core::time_of(recording.events[event]) <= fix.t_ns; ++event) {
      events.push_back(std::move(recording.events[event]));
    }
    events.emplace_back(fix);
  }
  for (; event < recording.events.size(); ++event) events.push_back(std::move(recording.events[event]));
  recording.events = std::move(events);
  if (recording.true_poses.empty()) return;
  put_truth_in_frame_of_fixes(recording, settings.sigma_m);
  recording.true_positions.clear();
  recording.antenna_robot_m.setZero();
}

}  // namespace helixnav::apps
