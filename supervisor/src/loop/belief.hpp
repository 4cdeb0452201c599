// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "association/confirmation.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "loop/coverage_trace.hpp"
#include "loop/tape.hpp"
#include "moving/moving_things.hpp"
#include "slip/slip_record.hpp"
#include "slip/vanished.hpp"
#include "smoothing/drive_map.hpp"
#include "window/window.hpp"

namespace helixnav::supervisor {

/// A part of the drive during which a question was open and was never decided, as lengths of the drive.
struct LeftOpen {
  double begun_path_m = 0.0;
  double ended_path_m = 0.0;
};

/// Everything that rolls back: pose and map, which landmarks exist, what ground was covered, which old landmark awaits
/// confirmation, how the vehicle slipped, what may move, what the last scan saw, and the number of scans so far.
struct Belief {
  cekf::CompressedEkf filter;
  association::LandmarkLife existence;
  CoverageTrace coverage;
  Confirmation confirmation;
  std::int64_t step = 0;
  SlipRecord slips = {};
  std::vector<LeftOpen> left_open = {};
  /// The drive as an atlas, up to some place before the last checkpoint; null as long as the tape has it all.
  std::shared_ptr<const DriveMap> drive = {};
  Window window = {};  ///< which part of it the filter holds
  MovingThings moving = {};
  SeenAgain seen_again = {};
  /// Length of the drive before everything in view vanished, until the pose is tied to the map again: slip/untied.hpp.
  std::optional<double> untied_since_m = {};
};

/// A belief to return to, and where the tape was then. A snapshot of O(n_a²) bytes and the landmarks' existence; valid as
/// long as the filter keeps the snapshot's phase, as take_checkpoint() tells it to: several scans may be processed in one
/// call, and the filter may have begun anew in it.
struct Checkpoint {
  cekf::Snapshot filter;
  association::LandmarkLife existence;
  Confirmation confirmation;
  std::int64_t step;
  Tape::Position position;
  SlipRecord slips = {};
  std::vector<LeftOpen> left_open = {};
  MovingThings moving = {};
  SeenAgain seen_again = {};
  std::optional<double> untied_since_m = {};
};

inline Checkpoint take_checkpoint(Belief& belief, const Tape& tape) {
  belief.filter.keep_open_phase();
  return {
      belief.filter.snapshot(), belief.existence, belief.confirmation, belief.step,          tape.end(), belief.slips,
      belief.left_open,         belief.moving,    belief.seen_again,   belief.untied_since_m};
}

/// Test: supervisor/tape_test.cpp.
inline void roll_back(const Checkpoint& checkpoint, Belief& belief) {
  belief.filter.restore(checkpoint.filter);
  belief.existence = checkpoint.existence;
  belief.coverage.back_to(checkpoint.existence.path_m());
  belief.confirmation = checkpoint.confirmation;
  belief.step = checkpoint.step;
  belief.slips = checkpoint.slips;
  belief.left_open = checkpoint.left_open;
  belief.moving = checkpoint.moving;
  belief.seen_again = checkpoint.seen_again;
  belief.untied_since_m = checkpoint.untied_since_m;
}

}  // namespace helixnav::supervisor
