// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/moving_options.hpp"
#include "moving/track.hpp"

namespace helixnav::supervisor {

/// What is known of the sensor and the world.
struct SightingRates {
  double detection_probability = 0.9;
  double extraneous_per_m2 = 0.0;  ///< observations of nothing mapped, per scan
  core::FieldOfView sure_view;     ///< within which a landmark is expected to be seen
  core::Pose2 T_robot_sensor;
};

/// Something that a scan showed to be moving.
struct Mover {
  std::vector<core::LandmarkId> landmarks;  ///< that it had begun, oldest first
  double nats = 0.0;                        ///< "it moves" against "it stands"
  double speed_mps = 0.0;                   ///< over the ground
};

/// Which of the things seen lately move. Each new landmark is followed as a Track until its sightings show that it
/// stands still, or nothing more is seen of it. The contributions of a scan:
///
/// - matched to where it stands: ln (N_moving / N_standing), or that of a missed mover and an extraneous observation;
/// - not where it stands, but an observation that began a landmark is where it should be if it moves:
///   ln (P_D N_moving / (P_missed λ)), with P_missed = 1 − P_D if it stands in view and was seen more than once, else
///   1: a false alarm is not missed.
///
/// It moves once the sum exceeds the limit. Then its landmarks are dropped, and its observations begin no more. A prior
/// that does not know the velocity charges a pair of clutter observations for the distance that it could have
/// explained.
/// Cost per scan: tracks × observations; a track lives for a few scans. Test: supervisor/moving/moving_things_test.cpp.
class MovingThings {
 public:
  void move(const core::Odometry& motion);

  /// One scan, after association and before it is used: observations of moving things become rejected in `fate`.
  /// Returns the movers found by this scan, whose landmarks are to be dropped. `seen`: the observations as points in
  /// the vehicle frame.
  std::vector<Mover> watch(core::Nanoseconds t_ns, const std::vector<SeenPoint>& seen, const SightingRates& rates,
                           const MovingOptions& options, std::vector<core::AssociationReport>& fate);

  /// After the scan has begun its landmarks: these are followed from now on.
  void begin(core::Nanoseconds t_ns, const std::vector<SeenPoint>& seen, const MovingOptions& options,
             const std::vector<core::AssociationReport>& fate);

  std::size_t tracks() const { return tracks_.size(); }

 private:
  std::vector<Track> tracks_;
  std::vector<int> taken_by_;  ///< [observation] of the last scan: the track that took it as a mover's; −1: none
};

}  // namespace helixnav::supervisor
