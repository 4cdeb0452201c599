// SPDX-License-Identifier: BSD-3-Clause
#include "moving/moving_things.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "helixnav/core/in_view.hpp"

namespace helixnav::supervisor {
namespace {

using core::AssociationReport;
using core::LandmarkId;
using core::Outcome;

constexpr int most_misses = 3;  // in a row, before a track ends
constexpr int nobody = -1;

/// As uncertain as uncalibrated odometry: what everything that stands still seems to do, at a few hundredths of the
/// vehicle's speed, is not motion. With 0.02, DLR, whose odometry is 8 % too long against its detector, is the same as
/// without; with 0.05, walkers pass for standing (docs/moving.md).
core::Odometry as_uncalibrated(core::Odometry motion) {
  constexpr double share = 0.03;
  const double off_m = share * motion.T_before_after.position_m().norm();
  const double off_rad = share * motion.T_before_after.heading_rad;
  motion.covariance.diagonal() += Eigen::Vector3d(off_m, off_m, off_rad).cwiseAbs2();
  return motion;
}

AssociationReport& fate_of(const SeenPoint& seen, std::vector<AssociationReport>& fate) {
  return fate[static_cast<std::size_t>(seen.observation)];
}

/// The observation by which the track's last landmark was seen again.
const SeenPoint* seen_standing(const Track& track, const std::vector<SeenPoint>& seen,
                               std::vector<AssociationReport>& fate) {
  if (track.landmarks().empty()) return nullptr;
  const auto found = std::find_if(seen.begin(), seen.end(), [&](const SeenPoint& one) {
    const AssociationReport& report = fate_of(one, fate);
    return report.outcome == Outcome::matched && report.landmark == track.landmarks().back();
  });
  return found == seen.end() ? nullptr : &*found;
}

/// The likeliest observation of a mover among those not taken yet: one that would begin a landmark, or one between the
/// track's own landmark and the nearest place where one might begin; any unmatched one if it is known to move.
const SeenPoint* seen_moving(const Track& track, bool is_known, const std::vector<SeenPoint>& seen,
                             const std::vector<int>& taken_by, std::vector<AssociationReport>& fate) {
  const SeenPoint* best = nullptr;
  double most = 0.0;
  for (const SeenPoint& one : seen) {
    const Outcome outcome = fate_of(one, fate).outcome;
    const bool may_be = outcome == Outcome::augmented || is_known || track.density_if_standing(one) > 0.0;
    const bool is_free =
        may_be && outcome != Outcome::matched && taken_by[static_cast<std::size_t>(one.observation)] == nobody;
    const double density = is_free ? track.density_if_moving(one) : 0.0;
    if (density > most) {
      most = density;
      best = &one;
    }
  }
  return best;
}

bool is_expected(const Track& track, const SightingRates& rates) {
  const Eigen::Vector2d at_m = core::transform(core::inverse(rates.T_robot_sensor), track.stands_m());
  const double range_m = at_m.norm();
  const double bearing_rad = std::atan2(at_m.y(), at_m.x());
  const core::FieldOfView& view = rates.sure_view;
  return range_m >= view.min_range_m && range_m <= view.max_range_m && core::is_between_bearings(view, bearing_rad);
}

}  // namespace

void MovingThings::move(const core::Odometry& motion) {
  const core::Odometry uncertain = as_uncalibrated(motion);
  for (Track& track : tracks_) track.change_frame(uncertain);
}

std::vector<Mover> MovingThings::watch(core::Nanoseconds t_ns, const std::vector<SeenPoint>& seen,
                                       const SightingRates& rates, const MovingOptions& options,
                                       std::vector<AssociationReport>& fate) {
  // The surest first: each observation is of one thing only.
  std::stable_sort(tracks_.begin(), tracks_.end(), [](const Track& a, const Track& b) { return a.nats() > b.nats(); });
  taken_by_.assign(fate.size(), nobody);
  const double missed = 1.0 - rates.detection_probability;
  std::vector<Mover> found;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    track.predict(t_ns);
    const bool is_known = track.nats() >= options.nats;
    const bool is_missed = track.was_seen_again() && is_expected(track, rates);
    const double missed_and_other = (is_missed ? missed : 1.0) * rates.extraneous_per_m2;
    const SeenPoint* one = seen_standing(track, seen, fate);
    if (one != nullptr) {
      const double moves = std::max(rates.detection_probability * track.density_if_moving(*one), missed_and_other);
      const double stands = std::max(rates.detection_probability * track.density_if_standing(*one), missed_and_other);
      track.see_standing(*one, std::log(moves / stands));
    } else if ((one = seen_moving(track, is_known, seen, taken_by_, fate)) != nullptr) {
      const double moves = rates.detection_probability * track.density_if_moving(*one);
      const double stands = std::max(rates.detection_probability * track.density_if_standing(*one), missed_and_other);
      track.see_moving(*one, std::log(moves / stands));
      taken_by_[static_cast<std::size_t>(one->observation)] = static_cast<int>(i);
    } else {
      track.miss();
      continue;
    }
    if (track.nats() < options.nats) continue;
    AssociationReport& report = fate_of(*one, fate);
    report.outcome = Outcome::rejected;
    report.landmark = core::no_landmark;
    std::vector<LandmarkId> landmarks = track.take_landmarks();
    if (!landmarks.empty()) found.push_back({std::move(landmarks), track.nats(), track.speed_mps()});
  }
  return found;
}

void MovingThings::begin(core::Nanoseconds t_ns, const std::vector<SeenPoint>& seen, const MovingOptions& options,
                         const std::vector<AssociationReport>& fate) {
  for (const SeenPoint& one : seen) {
    const AssociationReport& report = fate[static_cast<std::size_t>(one.observation)];
    const int owner = taken_by_[static_cast<std::size_t>(one.observation)];
    if (report.outcome != Outcome::augmented) continue;
    if (owner != nobody) {
      tracks_[static_cast<std::size_t>(owner)].begin_landmark(report.landmark);
    } else {
      tracks_.emplace_back(report.landmark, one, t_ns, options.speed_mps);
    }
  }
  const auto has_ended = [&](const Track& track) {
    return track.nats() < -options.nats || track.misses_in_a_row() > most_misses;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), has_ended), tracks_.end());
}

}  // namespace helixnav::supervisor
