// SPDX-License-Identifier: BSD-3-Clause
// The filter of a map that is too large for it begins anew where the vehicle is, from the atlas of the drive.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/navigation_loop.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double pause_m = 20.0;  ///< driven between attempts

/// How far from the estimated vehicle the things it sees may be mapped: both the vehicle and what is mapped there may
/// be off by its deviation since the start.
double drift_m(const cekf::CompressedEkf& filter) {
  constexpr double sigmas = 4.0;
  const double variance_m2 = filter.pose().covariance.topLeftCorner<2, 2>().trace();
  return sigmas * std::sqrt(std::max(0.0, variance_m2));
}

}  // namespace

/// From its start, or from an earlier map on.
bool NavigationLoop::is_drive_known() const {
  const bool is_whole = belief_.drive ? tape_.holds_since(belief_.drive->end()) : tape_.holds_drive();
  return is_whole && options_.search.closing != ClosingMethod::restart;
}

/// None begins while another map is asked for a place in it.
bool NavigationLoop::may_have_window() const {
  return is_drive_known() && (!apart_.any() || std::isfinite(belief_.window.radius_m));
}

/// A phase of the atlas holds what a few scans see, and costs the cube of it; a filter keeps it once. In a forest (68 trees seen in a
/// scan, 1146 in all) the atlas took 212 MB and 2.5 s more than it saved.
bool NavigationLoop::needs_window() const {
  constexpr double scans = 20.0;
  const auto mapped = static_cast<double>(belief_.existence.records().size());
  return mapped > options_.map.whole && mapped > scans * belief_.existence.seen_per_scan();
}

WindowNeeds NavigationLoop::window_to_map() const {
  constexpr int all = std::numeric_limits<int>::max();
  const bool is_part = std::isfinite(belief_.window.radius_m);
  if ((apart_.any() && !is_part) || !needs_window()) return {0.0, all, all};
  return window_about(belief_.filter);
}

WindowNeeds NavigationLoop::window_about(const cekf::CompressedEkf& filter) const {
  const double reach_m = view_.reach().value_or(reference_reach_m);
  return {5.0 * reach_m + drift_m(filter), options_.map.window, options_.map.most};
}

/// Most searches are decided within one attempt; the filter is not handed over meanwhile.
WindowNeeds NavigationLoop::window_to_search() const {
  const double reach_m = view_.reach().value_or(reference_reach_m) + options_.search.reach_m;
  return {reach_m + options_.search.attempt_m + drift_m(belief_.filter), options_.map.window, options_.map.most};
}

/// The drive in the atlas, up to now and solved.
std::shared_ptr<DriveMap> NavigationLoop::drive_until_now() const {
  auto drive = belief_.drive ? std::make_shared<DriveMap>(*belief_.drive) : begun_drive();
  drive->take(tape_, belief_.filter);
  drive->settle();
  return drive;
}

std::shared_ptr<DriveMap> NavigationLoop::begun_drive() const {
  return std::make_shared<DriveMap>(start_, phase_length_m(view_.reach().value_or(reference_reach_m)));
}

/// The joint estimate of the pose and of the landmarks of the window.
std::pair<cekf::CompressedEkf, Window> NavigationLoop::begun_window(const DriveMap& drive, const Belief& belief,
                                                                    const WindowNeeds& needs) const {
  const atlas::Atlas& atlas = drive.atlas();
  const Eigen::Vector2d here_m = atlas.pose().position_m();
  const double last_m = std::isfinite(belief.window.radius_m) ? belief.window.radius_m : 0.0;
  const double driven_m = belief.existence.path_m() + view_.reach().value_or(reference_reach_m);
  const double farthest_m = driven_m + 2.0 * drive.extent_m();
  ChosenWindow chosen =
      choose_window(places_about(atlas, belief.existence, here_m, needs, 1.1 * last_m, farthest_m), here_m, needs);
  chosen.window.begun_path_m = belief.existence.path_m();
  return {{atlas.joint(chosen.ids), belief.filter.next_name(), belief.filter.options()}, chosen.window};
}

/// The covariances of the landmarks that are left out are remembered as they are now.
void NavigationLoop::begin_window(std::shared_ptr<DriveMap> drive, const WindowNeeds& needs) {
  auto [filter, window] = begun_window(*drive, belief_, needs);
  drive->remember(belief_.filter);
  pending_.numerics.note(belief_.filter.take_health());
  std::swap(belief_.filter, filter);
  if (!undo_.filter) undo_.filter.emplace(std::move(filter));
  become(std::move(drive), window);
}

bool NavigationLoop::hand_over(const WindowNeeds& needs) {
  try {
    begin_window(drive_until_now(), needs);
    return true;
  } catch (const core::NumericalError&) {
    ++pending_.numerics.refused;  // what cannot be solved leaves the filter as it is
    pending_.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::window,
                                                            static_cast<double>(belief_.filter.mapped_count()),
                                                            static_cast<double>(options_.map.window)});
    return false;
  }
}

/// Landmarks that a filter begun anew here would hold.
int NavigationLoop::would_hold(const WindowNeeds& needs) const {
  const Eigen::Vector2d here_m = belief_.filter.pose().mean.position_m();
  const auto near = static_cast<int>(belief_.filter.landmarks_within(here_m, needs.least_radius_m).size());
  return std::min(needs.most, std::max(needs.landmarks, near));
}

/// If the vehicle nears the edge of its window, or the filter holds half as much again as a new one would; the first
/// hand-over has to halve it.
bool NavigationLoop::is_hand_over_due() const {
  const bool is_part = std::isfinite(belief_.window.radius_m);
  if (!is_part && !needs_window()) return false;
  if (belief_.existence.path_m() - belief_.window.begun_path_m <= pause_m) return false;
  // Early: where the vehicle sees little, on a street without trees, it may be long before it is trusted again.
  // But at most a share of the window's radius, or a small window would be handed over all the time.
  constexpr double most_share = 0.6;
  const double needed_m = std::min(3.0 * view_.reach().value_or(reference_reach_m) + 0.5 * drift_m(belief_.filter),
                                   most_share * belief_.window.radius_m);
  if (belief_.window.reach_from(belief_.filter.pose().mean.position_m()) < needed_m) return true;
  constexpr Tape::Position most_entries = 20000;
  if (belief_.drive && tape_.end() - belief_.drive->end() > most_entries) return true;
  const double most_growth = is_part ? 1.5 : 2.0;
  const double held = belief_.filter.mapped_count();
  return held > most_growth * options_.map.window && held > most_growth * would_hold(window_to_map());
}

/// A long drive, before the tape ceases to hold it from its start; if it could not be solved, it is tried again a few
/// times. From then on what came since, a little at a time, even if one filter holds the map for ever: a tape that is
/// never taken in grows without bound.
bool NavigationLoop::is_drive_due() const {
  constexpr double longer = 1.125;
  constexpr Tape::Position portion = 1000;  // entries: 20 ms
  const bool is_long = 2 * tape_.stops() > options_.search.smooth_up_to_scans || !tape_.holds_since(0);
  if (!belief_.drive) return is_long && belief_.existence.path_m() > longer * belief_.window.begun_path_m;
  const bool is_whole = std::isinf(belief_.window.radius_m);  // else a hand-over takes it in
  return is_long && is_whole && tape_.end() > std::max(belief_.drive->end(), belief_.window.tried) + portion;
}

void NavigationLoop::take_drive_if_due() {
  if (!is_drive_due()) return;
  Window tried = belief_.window;
  tried.begun_path_m = belief_.existence.path_m();
  tried.tried = tape_.end();
  std::shared_ptr<const DriveMap> drive = belief_.drive;
  try {
    drive = drive_until_now();
  } catch (const core::NumericalError&) {
    ++pending_.numerics.refused;
  }
  become(std::move(drive), tried);
}

/// The vehicle may soon see what the filter does not hold, and would map it a second time.
bool NavigationLoop::is_at_edge() const {
  constexpr double most_share = 0.3;
  const double needed_m = std::min(1.5 * view_.reach().value_or(reference_reach_m) + 0.5 * drift_m(belief_.filter),
                                   most_share * belief_.window.radius_m);
  return belief_.window.reach_from(belief_.filter.pose().mean.position_m()) < needed_m;
}

/// When the belief has just become trusted; at the edge of the window as it is, and then nothing rolls back past it.
void NavigationLoop::hand_over_if_due() {
  Mapping* mapping = std::get_if<Mapping>(&mode_);
  if (mapping == nullptr || !may_have_window()) return;
  const bool is_trusted = mapping->trusted->position == tape_.end();
  if (!is_trusted && !is_at_edge()) return;
  if (is_trusted) take_drive_if_due();
  if (!is_hand_over_due()) return;
  if (!undo_.mode) undo_.mode.emplace(Mode(*mapping));
  if (hand_over(window_to_map())) {
    trust(take_checkpoint(belief_, tape_));
    return;
  }
  Window tried = belief_.window;
  tried.begun_path_m = belief_.existence.path_m();
  become(belief_.drive, tried);
}

/// Before a search: everything that it may ask for has to be in the filter.
void NavigationLoop::widen_for_search() {
  if (!std::isfinite(belief_.window.radius_m) || !may_have_window()) return;
  const WindowNeeds needs = window_to_search();
  if (belief_.window.reach_from(belief_.filter.pose().mean.position_m()) < needs.least_radius_m) hand_over(needs);
}

void NavigationLoop::become(std::shared_ptr<const DriveMap> drive, const Window& window) {
  std::swap(belief_.drive, drive);
  if (!undo_.drive) undo_.drive.emplace(std::move(drive), belief_.window);
  belief_.window = window;
}

}  // namespace helixnav::supervisor
