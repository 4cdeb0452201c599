// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::supervisor {

/// The drive since a moment at which nothing was doubtful, so that it can be gone through again from there: filter and book
/// of landmarks of that moment, and what came in since. As the moment moves along while all is well, the filter mostly
/// keeps no phase but the open one for it. Memory: a snapshot, the book, about 200 bytes an observation, and
/// CompressedEkf::kept_bytes. Test: supervisor/history_test.cpp.
class History {
 public:
  /// Motion, with the length of road it covers.
  struct Motion {
    core::Odometry odometry;
    double driven_m;
  };
  using Event = std::variant<Motion, core::AbsoluteFix, core::Scan>;

  /// No effect before there is a moment to come back to.
  void note(Event event);
  /// The state after scan number `step` is one to come back to, and everything before is forgotten. A snapshot of
  /// O(n_a²) bytes: not taken more often than every ten scans, but after every switch of the region, so that the phase
  /// closed by it is let go.
  void settle(std::int64_t step, cekf::CompressedEkf& filter, const association::LandmarkLife& life);
  /// Forgets everything; the filter need not keep anything any more.
  void clear(cekf::CompressedEkf& filter);

  bool empty() const { return !moment_; }
  /// Of the moment to come back to. Not to be called while empty, nor is the next one.
  std::int64_t step() const { return moment_->step; }
  /// Filter and book are as they were at that moment. Returns what came in since, and forgets everything.
  std::vector<Event> rewind(cekf::CompressedEkf& filter, association::LandmarkLife& life);

 private:
  struct Moment {
    std::int64_t step;
    cekf::Snapshot filter;
    association::LandmarkLife life;
  };

  std::optional<Moment> moment_;
  std::vector<Event> since_;
};

}  // namespace helixnav::supervisor
