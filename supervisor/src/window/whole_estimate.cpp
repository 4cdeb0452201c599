// SPDX-License-Identifier: BSD-3-Clause
// Questions about the whole map, of which the filter may hold a part.
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "loop/navigation_loop.hpp"
#include "window/marginals.hpp"

namespace helixnav::supervisor {

/// A landmark placed by only one scan and left out by the filter may be in no phase of the drive.
bool NavigationLoop::is_placed(core::LandmarkId id) const {
  return belief_.filter.contains(id) || (belief_.drive && belief_.drive->atlas().knows(id));
}

std::vector<core::LandmarkId> NavigationLoop::landmarks() const {
  if (!belief_.drive) return belief_.filter.landmarks();
  std::vector<core::LandmarkId> ids;
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    if (is_placed(record.id)) ids.push_back(record.id);
  }
  return ids;
}

/// What the filter does not hold, as it was remembered when the filter left it out.
std::vector<core::PointGaussian> NavigationLoop::sketched(const std::vector<core::LandmarkId>& ids) const {
  const auto is_held = [&](core::LandmarkId id) { return belief_.filter.contains(id); };
  std::vector<core::LandmarkId> held, left_out;
  std::partition_copy(ids.begin(), ids.end(), std::back_inserter(held), std::back_inserter(left_out), is_held);
  std::vector<core::PointGaussian> from_filter = belief_.filter.marginals(held);
  if (left_out.empty()) return from_filter;
  const std::vector<core::PointGaussian> remembered = belief_.drive->remembered(left_out);
  std::vector<core::PointGaussian> points;
  points.reserve(ids.size());
  auto next_held = from_filter.begin();
  auto next_left_out = remembered.begin();
  for (const core::LandmarkId id : ids) points.push_back(is_held(id) ? *next_held++ : *next_left_out++);
  return points;
}

/// Of landmarks(), from the atlas, brought up to now.
std::vector<core::PointGaussian> NavigationLoop::marginals() const {
  return marginals_of(drive_until_now()->atlas(), landmarks());
}

/// From the filter where it holds them all, else from the atlas, brought up to now.
core::JointGaussian NavigationLoop::joint(const std::vector<core::LandmarkId>& ids) const {
  const auto is_held = [&](core::LandmarkId id) { return belief_.filter.contains(id); };
  if (std::all_of(ids.begin(), ids.end(), is_held)) return belief_.filter.joint(ids);
  return drive_until_now()->atlas().joint(ids);
}

/// Of landmarks(); nothing if the drive is not known or cannot be solved. What was measured after `until_m` of the drive is left out
/// as far as the atlas has not taken it in.
std::optional<core::JointMap> NavigationLoop::factored(const std::vector<core::MapLandmark>& landmarks, FactoredMap how,
                                                       double until_m) const {
  if (!is_drive_known()) return std::nullopt;
  try {
    if (how == FactoredMap::factors_alone && !belief_.drive) return unsolved_factors(landmarks, until_m);
    DriveMap drive = belief_.drive ? *belief_.drive : *begun_drive();
    drive.take(tape_until(until_m), belief_.filter);
    drive.settle();
    std::vector<core::MapLandmark> known;
    for (const core::MapLandmark& landmark : landmarks) {
      if (drive.atlas().knows(landmark.id)) known.push_back(landmark);
    }
    return factored_map(drive.atlas(), next_name(), known, how);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

core::JointMap NavigationLoop::unsolved_factors(const std::vector<core::MapLandmark>& landmarks, double until_m) const {
  const double phase_m = phase_length_m(view_.reach().value_or(reference_reach_m));
  core::MapFactors factors = DriveMap::unsolved(start_, phase_m, tape_until(until_m), belief_.filter);
  return factored_map(std::move(factors), belief_.filter.pose(), next_name(), landmarks);
}

Tape NavigationLoop::tape_until(double until_m) const {
  double path_m = belief_.existence.path_m();
  tape_.read_from(0, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) path_m -= motion->driven_m;
  });
  Tape::Position position = tape_.end();
  Tape::Position at = tape_.begin();
  tape_.read_from(0, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) path_m += motion->driven_m;
    if (path_m > until_m) position = std::min(position, at);
    ++at;
  });
  Tape tape = tape_;
  tape.cut(position);
  return tape;
}

}  // namespace helixnav::supervisor
