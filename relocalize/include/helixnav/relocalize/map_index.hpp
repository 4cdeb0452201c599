// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "helixnav/relocalize/landmark.hpp"

namespace helixnav::relocalize {

/// The two lengths from which all others follow.
struct IndexOptions {
  double reach_m = 30.0;      ///< how far the sensor sees landmarks
  double pair_noise_m = 0.1;  ///< σ per coordinate of the difference of one landmark seen from two sessions
};

/// A landmark map prepared for `ask`: triangles that landmarks form with two of their eight nearest neighbours, in bins of
/// their sides; where landmarks are; which ground was looked at. Contents, and therefore answers, depend on the
/// landmarks and discs given and not on the order of calls, except for the rounding of positions to 1e-7 of the
/// distance from the first. At most 2²⁴ landmarks, within 4e5 pair noises of the first.
///
/// Cost: about 20 µs per insertion or removal; in addition the bins are rebuilt whenever the map has almost doubled;
/// below 200 bytes per landmark from some thousands on, 16 more with kinds or sizes. Equations: docs/relocalize.md.
/// Test: relocalize/map_index_test.cpp (equals brute force and an index built anew after any calls).
class MapIndex {
 public:
  /// PreconditionError unless both lengths are positive and the reach is at least 20 pair noises.
  explicit MapIndex(const IndexOptions& options);

  /// The index of many landmarks at once, about five times as fast as inserting them.
  MapIndex(const IndexOptions& options, const std::vector<Landmark>& landmarks);

  MapIndex(const MapIndex& other);  ///< cost in proportion to the memory
  MapIndex& operator=(const MapIndex& other);
  MapIndex(MapIndex&&) noexcept;
  MapIndex& operator=(MapIndex&&) noexcept;
  ~MapIndex();

  /// PreconditionError, and no change, for a negative id, one that the map has, values that are not finite, a covariance
  /// that is not positive definite, or a point out of bounds.
  void insert(const Landmark& landmark);

  /// Whether a landmark there is within the bounds: of the first one, 4e5 pair noises along either axis. Beyond, the rounding of
  /// coordinates would reach a tenth of the noise.
  bool has_room_at(const Eigen::Vector2d& point_m) const;

  /// PreconditionError for an id that the map does not have.
  void erase(core::LandmarkId id);

  /// Replaces the landmark of the same id: erase and insert in one. PreconditionError as for these.
  void move(const Landmark& landmark);

  /// Marks ground where the map's sensor would have found landmarks. What is marked stays marked.
  void look_at(const Disc& ground);

  /// For a map whose covered ground was not recorded: a disc about each landmark, 0.6 of the way to its eighth neighbour.
  void look_around_landmarks();

  const IndexOptions& options() const;
  std::size_t size() const;
  bool contains(core::LandmarkId id) const;
  double looked_at_m2() const;
  bool has_looked_at(const Eigen::Vector2d& point_m) const;
  std::size_t triangles() const;
  std::size_t memory_bytes() const;

  /// All triangles as ids in rising order, sorted: what tests compare.
  std::vector<std::array<core::LandmarkId, 3>> list_triangles() const;

  struct Parts;  ///< private to the sources of this folder
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace helixnav::relocalize
