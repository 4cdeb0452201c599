// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_feed.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "helixnav/mrpt_adapter/run_access.hpp"

namespace helixnav::apps {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;

bool shows_landmarks(const CObservation::Ptr& observation) {
  return dynamic_cast<const mrpt::obs::CObservationBearingRange*>(observation.get()) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(observation.get()) != nullptr;
}

void check_time(const CObservation& observation) {
  if (mrpt_adapter::time_of(observation)) return;
  throw core::InputError(std::string(observation.GetRuntimeClass()->className) + " \"" + observation.sensorLabel +
                         "\" has no time");
}

}  // namespace

SlamFeed::SlamFeed(mrpt_adapter::MapBuilder& builder, Seen seen) : builder_(builder), seen_(std::move(seen)) {}

void SlamFeed::take(const RawlogTurn& turn) {
  if (turn.frame) {
    take(turn.frame, turn.movement);
  } else if (turn.observation) {
    observe(turn.observation, turn.movement);
  } else {
    mrpt::obs::CSensoryFrame nothing_seen;
    feed(nothing_seen, turn.movement);
  }
}

void SlamFeed::take(const mrpt::obs::CSensoryFrame::Ptr& frame, CActionCollection::Ptr movement) {
  const auto landmarks = std::count_if(frame->begin(), frame->end(), shows_landmarks);
  if (landmarks > 1) {
    std::vector<CObservation::Ptr> in_turn(frame->begin(), frame->end());
    std::stable_sort(in_turn.begin(), in_turn.end(),
                     [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
    for (const CObservation::Ptr& observation : in_turn) observe(observation, std::exchange(movement, nullptr));
    return;
  }
  const auto shows = std::find_if(frame->begin(), frame->end(), shows_landmarks);
  if (shows != frame->end()) check_time(**shows);
  feed(*frame, movement);
  if (shows != frame->end() && !mrpt_adapter::RunAccess::last_steps(builder_).empty()) seen_(**shows);
}

void SlamFeed::observe(const CObservation::Ptr& observation, const CActionCollection::Ptr& movement) {
  const bool shows = shows_landmarks(observation);
  if (shows) check_time(*observation);
  if (movement) {
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    feed(frame, movement);
  } else {
    builder_.processObservation(observation);
  }
  if (shows && !mrpt_adapter::RunAccess::last_steps(builder_).empty()) seen_(*observation);
}

void SlamFeed::feed(mrpt::obs::CSensoryFrame& frame, const CActionCollection::Ptr& movement) {
  CActionCollection none;
  builder_.processActionObservation(movement ? *movement : none, frame);
}

}  // namespace helixnav::apps
