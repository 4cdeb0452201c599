// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {

struct SensorPlaces;
struct WaitingLandmark;

struct DelayedOptions {
  int window = 16;                  ///< sightings kept per landmark, and a quarter of the places kept for all
  double spacing_m = 1.0;           ///< minimum distance the sensor moves between two kept sightings
  double same_m = 0.1;              ///< solutions of a fit closer together than this are one
  double ahead_m = 10.0;            ///< from a clone of the sensor to the point that keeps its heading
  double clone_sigma_m = 0.001;     ///< keeps the filter's covariance positive definite
  double max_relative_sigma = 0.1;  ///< largest σ of the landmark relative to the robot, as a fraction of its distance
  double fit_probability = 0.999;   ///< χ² gate of the fit to all sightings kept
  double min_rival_margin = 14.0;   ///< every other solution must be worse by this much in twice the log-likelihood
  bool names_may_be_wrong =
      true;  ///< one sighting may be of another landmark and is sought if they disagree; set by NamedNavigator
};

/// A sighting, in a scan, of something that is not yet in the map.
struct DelayedSighting {
  std::int64_t identity = 0;
  core::Observation observation;
};

/// Landmarks seen only as a bearing or a range: they enter the filter once sightings from several places determine them
/// as Gaussians, not before. A place of the sensor from which sightings are kept is cloned into the filter, as a point and,
/// for bearings, a second one ahead of it, so that past places stay exactly correlated with the pose and with each other.
/// All landmarks that wait are fitted together with the places they were seen from (fit_jointly), since their common
/// sightings tell how the vehicle turned better than odometry does. Those that are certain enough enter: what their
/// sightings say about the places updates the filter, and each landmark is derived from the places then
/// (docs/names.md). This is the update that the sightings would have made together; each counts once.
/// A landmark waits while another solution explains its sightings nearly as well (the mirror image across a straight path).
/// Cost per place kept: a fit of all landmarks in view, some ms; memory 16 to 64 places.
/// Source: docs/names.md. Test: supervisor/named/delayed_landmarks_test.cpp.
class DelayedLandmarks {
 public:
  explicit DelayedLandmarks(const DelayedOptions& options = {}) : options_(options) {}

  /// Call once the sensor is known, before the first sighting.
  void set_lengths(const DelayedOptions& options) { options_ = options; }

  /// Takes the sightings of a scan, from the filter's current pose, of what is not yet in the map. Returns for each the
  /// landmark, if it has entered. An identity that occurs twice is a PreconditionError.
  std::vector<std::optional<core::LandmarkId>> sight(cekf::CompressedEkf& filter,
                                                     const std::vector<DelayedSighting>& sightings,
                                                     const core::Pose2& T_robot_sensor);

  /// Points of the filter that are clones, not landmarks.
  int clones() const;

 private:
  /// Where the sensor was.
  struct Place {
    core::LandmarkId position = core::no_landmark;
    core::LandmarkId ahead = core::no_landmark;  ///< if something was seen as a bearing
    double along_m = 0.0;                        ///< from the first place
    core::Pose2 T_robot_sensor;
  };
  using PlaceNumber = std::int64_t;
  using PlacesInUse = std::map<PlaceNumber, Eigen::Index>;  ///< with the first of the coordinates of each
  struct Waiting {
    std::map<PlaceNumber, core::Observation> seen;
    std::optional<Eigen::Vector2d> guess_m;  ///< in the map, from its own sightings
    double guessed_at_m = -1.0;              ///< along the places, when a guess was last tried
  };

  bool is_due(const cekf::CompressedEkf& filter, std::int64_t identity, const core::Pose2& T_robot_sensor,
              double spacing_m) const;
  double distance_m(const cekf::CompressedEkf& filter, const Place& place, const core::Pose2& T_robot_sensor) const;
  void keep(cekf::CompressedEkf& filter, const std::vector<DelayedSighting>& sightings,
            const core::Pose2& T_robot_sensor);
  void thin_out();
  template <class ByNumber>
  PlaceNumber least_needed(const ByNumber& by_number) const;
  void forget_place(PlaceNumber number);
  void remove_unused_places(cekf::CompressedEkf& filter);
  PlacesInUse places_in_use(const std::vector<DelayedSighting>& sightings) const;
  std::vector<WaitingLandmark> with_guesses(const std::vector<DelayedSighting>& sightings, const PlacesInUse& used,
                                            const SensorPlaces& places);
  bool is_worth_a_guess(const Waiting& waiting) const;
  std::map<std::int64_t, core::LandmarkId> enter(cekf::CompressedEkf& filter,
                                                 const std::vector<DelayedSighting>& sightings);

  DelayedOptions options_;
  PlaceNumber next_place_ = 0;
  std::map<PlaceNumber, Place> places_;
  std::map<std::int64_t, Waiting> waiting_;
};

}  // namespace helixnav::supervisor
