// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {

/// Snapshots of one filter that together reach back a number of scans, across region switches: the filter keeps the
/// phases they belong to. Between two snapshots the caller replays. Memory: reach / stride snapshots plus
/// CompressedEkf::kept_bytes. Test: tests/cekf/snapshot_test.cpp.
class SnapshotRing {
 public:
  /// Reaches back at least `reach` steps once that many have been offered; one snapshot every `stride` steps.
  explicit SnapshotRing(int reach = 200, int stride = 10);

  /// After step number `step` (rising): takes a snapshot when one is due, lets go of what is no longer needed.
  void offer(CompressedEkf& filter, std::int64_t step);

  /// Restores the latest snapshot taken at or before `step`, forgets the later ones and returns the step it was taken
  /// after: replay begins with the next. PreconditionError when the ring does not reach back so far.
  std::int64_t rewind(CompressedEkf& filter, std::int64_t step);

  bool reaches(std::int64_t step) const { return !entries_.empty() && entries_.front().step <= step; }
  std::size_t bytes() const;

 private:
  struct Entry {
    std::int64_t step;
    Snapshot snapshot;
  };

  int reach_;
  int stride_;
  std::deque<Entry> entries_;
};

}  // namespace helixnav::cekf
