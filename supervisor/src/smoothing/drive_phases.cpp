// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/drive_phases.hpp"

#include <utility>

#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

class Cutter {
 public:
  Cutter(double length_m, bool begins_drive, const PhaseNames& names)
      : length_m_(length_m), begins_drive_(begins_drive), names_(names) {}

  void stop(const Stop& stop) {
    if (stop.motion) wait(*stop.motion);
    if (stop.repeats) {
      phase_.stops.push_back({stop.t_ns, static_cast<int>(log_.steps.size()) - 1});
      return;
    }
    go_on();
    see(stop.seen);
    if (stop.fix && log_.steps.empty()) stand_still();
    phase_.stops.push_back({stop.t_ns, static_cast<int>(log_.steps.size()) - 1});
    if (stop.fix) phase_.fix = softened(*stop.fix);
    if (stop.fix || driven_m_ >= length_m_) close();
  }

  /// Motion that ends where nothing needs to be known about the vehicle.
  void wait(const core::Odometry& odometry) { waiting_ = waiting_ ? core::chain(*waiting_, odometry) : odometry; }

  std::vector<DrivePhase> phases() && {
    go_on();
    const bool is_empty = phase_.stops.empty() && log_.steps.empty();
    if (!is_empty && log_.steps.empty()) stand_still();
    if (!is_empty) close();
    return std::move(phases_);
  }

 private:
  void drive(const core::Odometry& odometry) {
    atlas::LoggedStep step;
    step.T_before_after = odometry.T_before_after;
    step.covariance = odometry.covariance;
    step.covariance.diagonal() += softening().cwiseAbs2();
    log_.steps.push_back(std::move(step));
    driven_m_ += odometry.T_before_after.position_m().norm();
  }

  void go_on() {
    if (waiting_) drive(*waiting_);
    waiting_.reset();
  }

  void stand_still() { drive(core::no_motion(0)); }

  void see(const std::vector<cekf::Match>& matches) {
    std::vector<atlas::SeenLandmark> seen;
    for (const cekf::Match& match : matches) {
      const core::LandmarkId id = names_.now(match.landmark);
      if (names_.is_worth_it(id)) seen.push_back({id, match.T_robot_sensor, match.observation});
    }
    if (seen.empty()) return;
    const bool at_start = log_.steps.empty() && phases_.empty() && begins_drive_;
    if (log_.steps.empty() && !at_start) stand_still();
    std::vector<atlas::SeenLandmark>& there = at_start ? log_.seen_at_entry : log_.steps.back().seen;
    there.insert(there.end(), seen.begin(), seen.end());
  }

  static core::AbsoluteFix softened(core::AbsoluteFix fix) {
    fix.covariance_m2.diagonal() += softening().head<2>().cwiseAbs2();
    return fix;
  }

  void close() {
    phase_.log = std::make_shared<const atlas::PhaseLog>(std::exchange(log_, {}));
    phases_.push_back(std::exchange(phase_, {}));
    driven_m_ = 0.0;
  }

  double length_m_;
  bool begins_drive_;
  const PhaseNames& names_;
  atlas::PhaseLog log_;
  DrivePhase phase_;
  std::optional<core::Odometry> waiting_;
  double driven_m_ = 0.0;
  std::vector<DrivePhase> phases_;
};

}  // namespace

std::vector<DrivePhase> phases_of(const std::vector<Stop>& stops, const std::optional<core::Odometry>& motion,
                                  double length_m, bool begins_drive, const PhaseNames& names) {
  Cutter cutter(length_m, begins_drive, names);
  for (const Stop& stop : stops) cutter.stop(stop);
  if (motion) cutter.wait(*motion);
  return std::move(cutter).phases();
}

Eigen::Vector3d softening() { return {2e-5, 2e-5, 2e-6}; }

core::PoseGaussian softened_start(core::PoseGaussian start) {
  if (!start.covariance.isZero(0.0)) start.covariance.diagonal() += softening().cwiseAbs2();
  return start;
}

double phase_length_m(double reach_m) {
  constexpr double phase_share = 2.0 / 3.0;
  return phase_share * reach_m;
}

}  // namespace helixnav::supervisor
