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

/// How far from the estimated vehicle what it sees may be mapped: both it and what is mapped there may be off by its deviation
/// since the start.
double drift_m(const cekf::CompressedEkf& filter) {
  constexpr double sigmas = 4.0;
  const double variance_m2 = filter.pose().covariance.topLeftCorner<2, 2>().trace();
  return sigmas * std::sqrt(std::max(0.0, variance_m2));
}

}  // namespace

/// The drive is known from its begin, and no other map is asked for a place in it.
bool NavigationLoop::may_have_window() const {
  const bool is_whole = belief_.drive ? tape_.holds_since(belief_.drive->end()) : tape_.holds_drive();
  return is_whole && !apart_.any() && options_.search.closing != ClosingMethod::restart;
}

bool NavigationLoop::needs_window() const {
  return static_cast<int>(belief_.existence.records().size()) > options_.map.whole;
}

WindowNeeds NavigationLoop::window_to_map() const {
  constexpr int all = std::numeric_limits<int>::max();
  if (apart_.any() || !needs_window()) return {0.0, all, all};
  const double reach_m = view_.reach().value_or(reference_reach_m);
  return {5.0 * reach_m + drift_m(belief_.filter), options_.map.window, options_.map.most};
}

/// A search is decided within one attempt, mostly; the filter is not handed over meanwhile.
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

/// The filter becomes the joint estimate of the pose and of the landmarks of the window; covariances of those that are left out
/// are remembered as they are now.
void NavigationLoop::begin_window(std::shared_ptr<DriveMap> drive, const WindowNeeds& needs) {
  const atlas::Atlas& atlas = drive->atlas();
  ChosenWindow chosen = choose_window(drive->places(), belief_.existence, atlas.pose().position_m(), needs);
  cekf::CompressedEkf filter(atlas.joint(chosen.ids), belief_.filter.next_name(), belief_.filter.options());
  chosen.window.begun_path_m = belief_.existence.path_m();
  drive->remember(belief_.filter);
  std::swap(belief_.filter, filter);
  if (!undo_.filter) undo_.filter.emplace(std::move(filter));
  become(std::move(drive), chosen.window);
}

bool NavigationLoop::hand_over(const WindowNeeds& needs) {
  try {
    begin_window(drive_until_now(), needs);
    return true;
  } catch (const core::NumericalError&) {
    return false;  // what cannot be solved leaves the filter as it is
  }
}

/// Where the belief has just become trusted: when the vehicle nears the edge of its window, or the filter has grown.
void NavigationLoop::hand_over_if_due() {
  Mapping* mapping = std::get_if<Mapping>(&mode_);
  if (mapping == nullptr || mapping->trusted->position != tape_.end() || !may_have_window()) return;
  const bool is_part = std::isfinite(belief_.window.radius_m);
  if (!is_part && !needs_window()) return;
  const int held = belief_.filter.mapped_count();
  const bool has_grown = 2 * held > 3 * std::max(options_.map.window, belief_.window.landmarks);
  // Early: where the vehicle sees little, on a street without trees, it may be long before it is trusted again.
  // No farther than that of a window that does not reach so far, or it would be handed over all the time.
  constexpr double most_share = 0.6;
  const double needed_m = std::min(3.0 * view_.reach().value_or(reference_reach_m) + 0.5 * drift_m(belief_.filter),
                                   most_share * belief_.window.radius_m);
  const bool at_edge = belief_.window.reach_from(belief_.filter.pose().mean.position_m()) < needed_m;
  constexpr Tape::Position most_entries = 20000;
  const bool is_long = belief_.drive && tape_.end() - belief_.drive->end() > most_entries;
  constexpr double pause_m = 20.0;
  const bool is_new = belief_.existence.path_m() - belief_.window.begun_path_m > pause_m;
  if (!is_new || !(has_grown || at_edge || is_long)) return;
  if (!undo_.mode) undo_.mode.emplace(Mode(*mapping));
  if (hand_over(window_to_map())) {
    trust(take_checkpoint(belief_, tape_));
    return;
  }
  Window tried = belief_.window;
  tried.begun_path_m = belief_.existence.path_m();
  become(belief_.drive, tried);
}

/// Before a search: all that it may ask for has to be in the filter.
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
