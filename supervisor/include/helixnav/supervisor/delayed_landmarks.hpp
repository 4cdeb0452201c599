// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {

struct DelayedOptions {
  int window = 16;         ///< sightings kept per landmark; when full, every other one is dropped and spacing doubles
  double spacing_m = 1.0;  ///< minimum distance the sensor moves between two kept sightings
  double same_m = 0.1;     ///< solutions of a fit closer together than this are one
  double ahead_m = 10.0;   ///< from a clone of the sensor to the point that keeps its heading
  double clone_sigma_m = 0.001;     ///< keeps the filter's covariance positive definite
  double max_relative_sigma = 0.1;  ///< largest σ of the landmark relative to the robot, as a fraction of its distance
  double fit_probability = 0.999;   ///< χ² gate of the fit to all sightings kept
  double min_rival_margin = 14.0;   ///< every other solution must be worse by this much in twice the log-likelihood
  bool names_may_be_wrong =
      true;  ///< one sighting may be of another landmark and is sought if they disagree; set by NamedNavigator
};

/// Landmarks seen only as a bearing or a range: they enter the filter once sightings from several places determine them
/// as Gaussians, not before. Each kept sighting leaves a clone of the sensor in the filter: its position as a map point
/// and, for bearings, a second point ahead of it. The past sensor positions thus stay exactly correlated with the pose
/// and with each other, whatever the filter learns meanwhile, and the landmark enters with exact first-order
/// correlations (CompressedEkf::augment of a DerivedPoint); each sighting counts once. The clones are then removed from
/// the filter. The fit is weighted least squares over the landmark in the robot frame, from many starts: while another
/// solution explains the sightings nearly as well (the mirror image across a straight path), the landmark waits.
/// Cost per kept sighting: about 1000 Cholesky factors of order `window`, 1 to 5 ms.
/// Test: supervisor/named/delayed_landmarks_test.cpp.
class DelayedLandmarks {
 public:
  explicit DelayedLandmarks(const DelayedOptions& options = {}) : options_(options) {}

  /// Call once the sensor is known, before the first sighting.
  void set_lengths(const DelayedOptions& options) { options_ = options; }

  /// Takes a sighting, from the filter's current pose, of something not yet in the map. Returns the landmark if it has
  /// entered.
  std::optional<core::LandmarkId> sight(cekf::CompressedEkf& filter, std::int64_t identity,
                                        const core::Observation& observation, const core::Pose2& T_robot_sensor);

  /// True for points of the filter that are clones, not landmarks.
  bool is_clone(core::LandmarkId id) const;
  int clones() const;

 private:
  struct Sighting {
    core::Observation observation;
    core::LandmarkId position = core::no_landmark;
    core::LandmarkId ahead = core::no_landmark;  ///< bearings only
  };
  struct Window {
    std::vector<Sighting> sightings;
    double spacing_m = 0.0;
  };

  void thin_out(cekf::CompressedEkf& filter, Window& window) const;

  DelayedOptions options_;
  std::map<std::int64_t, Window> windows_;
};

}  // namespace helixnav::supervisor
