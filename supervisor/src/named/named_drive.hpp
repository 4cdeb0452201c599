// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/atlas/phase_factor.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "loop/tape.hpp"
#include "smoothing/drive_phases.hpp"

namespace helixnav::supervisor {

/// The drive of a NamedNavigator since its start: closed phases in an atlas, and the stops since the last of them. None
/// of it is ever decided differently later, so a phase goes into the atlas as soon as it has been driven. Memory:
/// 250 bytes per observation and 30 kB per phase, half a kilobyte once it is condensed (Atlas::condense).
/// Test: supervisor/named/named_window_test.cpp.
class NamedDrive {
 public:
  /// `most_stops`: how many may wait for the atlas; a longer drive that is not put into it is not kept at all.
  NamedDrive(const core::PoseGaussian& start, int most_stops);

  /// Where the drive was, to roll back to. Valid until a phase is closed.
  struct Mark {
    std::size_t stops = 0;
    std::optional<core::Odometry> motion;
  };
  Mark mark() const { return {stops_.size(), motion_}; }
  void back_to(const Mark& mark) noexcept;

  void move(const core::Odometry& motion);
  /// A scan or a fix after the motion so far; strong guarantee.
  void stop(Stop stop);

  /// The drive is no longer needed: forgets it and whatever follows.
  void drop() noexcept;
  bool is_kept() const { return kept_; }

  /// Whether the stops since the last phase make a whole one.
  bool has_phase(double length_m) const;
  /// Puts one into the atlas. `known`: landmarks in the frame of its entry, where it is looked for. Strong guarantee.
  void close_phase(double length_m, const atlas::PointPrior* known);
  /// Motion by odometry over the stops that close_phase would take, or over all while they do not make a whole phase.
  core::Pose2 T_entry_exit(double length_m) const;

  /// Puts all stops into the atlas and settles it; `known` as above, for the first phase. After an error the drive has
  /// to be discarded.
  void settle(double length_m, const atlas::PointPrior* known);
  const atlas::Atlas& atlas() const { return atlas_; }
  int phases() const { return phases_; }  ///< in the atlas, settled or not

 private:
  std::size_t stops_of_phase(double length_m) const;
  void add(const std::vector<DrivePhase>& phases, const atlas::PointPrior* known, atlas::Atlas& atlas) const;

  int most_stops_;
  bool kept_;
  atlas::Atlas atlas_;
  int phases_ = 0;
  bool begins_ = true;  ///< the atlas has no phase yet
  std::deque<Stop> stops_;
  std::optional<core::Odometry> motion_;  ///< since the last stop
};

}  // namespace helixnav::supervisor
