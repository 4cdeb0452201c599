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
  int window = 16;         ///< sightings kept of one landmark; when full, every second one goes and the spacing doubles
  double spacing_m = 1.0;  ///< so far the sensor moves between two sightings that are kept
  double same_m = 0.1;     ///< solutions of a fit nearer to one another are one
  double ahead_m = 10.0;   ///< from a clone of the sensor to the point that keeps its heading
  double clone_sigma_m = 0.001;     ///< keeps the filter's covariance positive definite
  double max_relative_sigma = 0.1;  ///< largest σ of the landmark, relative to the robot, by its distance
  double fit_probability = 0.999;   ///< χ² gate of the fit to all sightings kept
  double min_rival_margin = 14.0;   ///< twice the log-likelihood by which every other solution must be worse
  bool names_may_be_wrong =
      true;  ///< one sighting may be of another landmark, and is sought where they contradict; NamedNavigator sets it
};

/// Landmarks seen as a bearing or a range only: they enter the filter when the sightings from several places fix them as
/// Gaussians, not before. Each sighting kept leaves a clone of the sensor in the filter: its position as a point of the
/// map, for bearings a second point ahead of it. So the past places stay exactly correlated with the pose and with each
/// other, whatever the filter learns meanwhile, and the landmark enters with exact first-order correlations
/// (CompressedEkf::augment of a DerivedPoint); each sighting counts once. The clones then leave the filter. The fit is
/// weighted least squares over the landmark in the frame of the robot, from many starts: while another solution explains
/// the sightings nearly as well (the mirror image across a straight path) the landmark waits.
/// Cost of a sighting kept: some 1000 Cholesky factors of order `window`, 1 to 5 ms. Test:
/// supervisor/named/delayed_landmarks_test.cpp.
class DelayedLandmarks {
 public:
  explicit DelayedLandmarks(const DelayedOptions& options = {}) : options_(options) {}

  /// Once the sensor is known, before the first sighting.
  void set_lengths(const DelayedOptions& options) { options_ = options; }

  /// A sighting, from the filter's present pose, of something that is not yet in the map. The landmark, when it entered.
  std::optional<core::LandmarkId> sight(cekf::CompressedEkf& filter, std::int64_t identity,
                                        const core::Observation& observation, const core::Pose2& T_robot_sensor);

  /// True for points of the filter that are clones and no landmarks.
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
