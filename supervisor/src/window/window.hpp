// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Which landmarks the filter holds of a map that is too large for it: all within radius_m of center_m as it was when
/// the filter began, and those begun since.
struct Window {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double radius_m = std::numeric_limits<double>::infinity();  ///< infinite: the whole map
  int landmarks = 0;                                          ///< when the filter began, and …
  double begun_path_m = 0.0;                                  ///< … the length of the drive then
  std::size_t tried = 0;  ///< position on the tape up to where the drive was tried to be taken in

  /// Around a place, the distance within which every landmark is held.
  double reach_from(const Eigen::Vector2d& point_m) const { return radius_m - (point_m - center_m).norm(); }
};

/// What a window has to hold: everything within least_radius_m, more while it has fewer than `landmarks`; if there are
/// more than `most`, the nearest.
struct WindowNeeds {
  double least_radius_m = 0.0;
  int landmarks = 0;
  int most = 0;
};

struct ChosenWindow {
  Window window;
  std::vector<core::LandmarkId> ids;  ///< increasing
};

/// What choose_window needs of the landmarks of an atlas: all within what is needed and those beyond it until one is
/// left out. `first_m`: the distance to look within first; nothing is farther than `farthest_m`. O(those).
/// Test: supervisor/window_test.cpp.
std::vector<atlas::Place> places_about(const atlas::Atlas& atlas, const association::LandmarkLife& existence,
                                       const Eigen::Vector2d& center_m, const WindowNeeds& needs, double first_m,
                                       double farthest_m);

/// The window around a place, of the landmarks of `places`. O(places). Test: supervisor/window_test.cpp.
ChosenWindow choose_window(const std::vector<atlas::Place>& places, const Eigen::Vector2d& center_m,
                           const WindowNeeds& needs);

}  // namespace helixnav::supervisor
