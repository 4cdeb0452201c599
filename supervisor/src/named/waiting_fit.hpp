// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/supervisor/delayed_landmarks.hpp"
#include "named/fit_jointly.hpp"
#include "named/sensor_places.hpp"

namespace helixnav::supervisor {

/// A landmark that waits, as it is fitted: its rows from the places of the sensor, and where it may be relative to the
/// robot.
struct WaitingLandmark {
  std::int64_t identity = 0;
  std::vector<FitRow> rows;
  std::optional<Eigen::Vector2d> guess_m;
  bool enters = false;  ///< certain enough
};

/// Where a landmark is according to its own sightings, if they have one answer.
struct OwnGuess {
  std::optional<Eigen::Vector2d> point_m;
  std::optional<std::size_t> wrong_row;  ///< of another landmark: all others agree without it
};
OwnGuess guess_alone(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, const DelayedOptions& options);

/// Landmarks fitted together: those that enter, and those that only help to fix the places.
struct DeterminedLandmarks {
  std::vector<WaitingLandmark> landmarks;
  JointFit fit;
  double noise_scale = 1.0;                ///< of variances, by how well the sightings agree; at least 1
  std::vector<std::int64_t> contradicted;  ///< left out of the fit
};

/// Fits all landmarks together, without those that their sightings contradict. Those enter that are certain enough, Gaussian
/// and have no other solution, by their own sightings without the rest, if possible. If none is certain by those alone but
/// two or more are with the help of the rest, they enter with its help: all sightings of the rest are used up, too.
DeterminedLandmarks determined(std::vector<WaitingLandmark> waiting, const Eigen::MatrixXd& P,
                               const DelayedOptions& options);

/// What the sightings of the landmarks say about the places alone, as an update of the clones.
cekf::PointRows rows_about_places(const DeterminedLandmarks& found, const SensorPlaces& places);

/// The landmark given the places as they are now, for the filter. Nothing if its rows do not determine it.
std::optional<cekf::DerivedPoint> derived_from_places(const std::vector<FitRow>& rows, const Eigen::Vector2d& near_m,
                                                      const SensorPlaces& places, double same_m);

}  // namespace helixnav::supervisor
