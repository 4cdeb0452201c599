// SPDX-License-Identifier: BSD-3-Clause
#include "window/window.hpp"

#include <algorithm>
#include <utility>

namespace helixnav::supervisor {

namespace {

std::vector<atlas::Place> existing(std::vector<atlas::Place> places, const association::LandmarkLife& existence) {
  const auto is_gone = [&](const atlas::Place& place) { return !existence.contains(place.id); };
  places.erase(std::remove_if(places.begin(), places.end(), is_gone), places.end());
  return places;
}

}  // namespace

std::vector<atlas::Place> places_about(const atlas::Atlas& atlas, const association::LandmarkLife& existence,
                                       const Eigen::Vector2d& center_m, const WindowNeeds& needs, double first_m,
                                       double farthest_m) {
  constexpr double wider = 1.4;
  const auto is_beyond = [&](const atlas::Place& place) {
    return (place.point_m - center_m).norm() > needs.least_radius_m;
  };
  const auto wanted = static_cast<std::size_t>(needs.landmarks);
  if (wanted >= existence.records().size()) return existing(atlas.landmarks(), existence);
  for (double radius_m = std::max(first_m, wider * needs.least_radius_m); radius_m < farthest_m; radius_m *= wider) {
    std::vector<atlas::Place> places = existing(atlas.near(center_m, radius_m), existence);
    if (places.size() > wanted && std::any_of(places.begin(), places.end(), is_beyond)) return places;
  }
  return existing(atlas.landmarks(), existence);
}

ChosenWindow choose_window(const std::vector<atlas::Place>& places, const Eigen::Vector2d& center_m,
                           const WindowNeeds& needs) {
  std::vector<std::pair<double, core::LandmarkId>> by_distance;
  for (const atlas::Place& place : places) by_distance.emplace_back((place.point_m - center_m).norm(), place.id);
  std::sort(by_distance.begin(), by_distance.end());
  const auto within = std::lower_bound(by_distance.begin(), by_distance.end(),
                                       std::make_pair(needs.least_radius_m, core::no_landmark)) -
                      by_distance.begin();
  const auto all = static_cast<std::ptrdiff_t>(by_distance.size());
  const std::ptrdiff_t wanted = std::max<std::ptrdiff_t>(within, needs.landmarks);
  const auto count = static_cast<std::size_t>(std::min({wanted, std::ptrdiff_t{needs.most}, all}));
  ChosenWindow chosen;
  chosen.window.center_m = center_m;
  chosen.window.landmarks = static_cast<int>(count);
  if (count < by_distance.size()) chosen.window.radius_m = by_distance[count].first;
  for (std::size_t i = 0; i < count; ++i) chosen.ids.push_back(by_distance[i].second);
  std::sort(chosen.ids.begin(), chosen.ids.end());
  return chosen;
}

}  // namespace helixnav::supervisor
