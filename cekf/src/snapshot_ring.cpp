// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/snapshot_ring.hpp"

#include <sstream>

#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

SnapshotRing::SnapshotRing(int reach, int stride) : reach_(reach), stride_(stride) {
  if (reach < 1 || stride < 1) throw core::PreconditionError("SnapshotRing: reach and stride must be at least 1");
}

void SnapshotRing::offer(CompressedEkf& filter, std::int64_t step) {
  if (!entries_.empty() && step - entries_.back().step < stride_) return;
  entries_.push_back({step, filter.snapshot()});
  while (entries_.size() > 1 && entries_[1].step <= step - reach_) entries_.pop_front();
  filter.keep_since(entries_.front().snapshot.phase);
}

std::int64_t SnapshotRing::rewind(CompressedEkf& filter, std::int64_t step) {
  if (!reaches(step)) {
    std::ostringstream problem;
    problem << "SnapshotRing: step " << step << " is out of reach; ";
    if (entries_.empty()) {
      problem << "the ring is empty";
    } else {
      problem << "the oldest snapshot was taken after step " << entries_.front().step;
    }
    throw core::PreconditionError(problem.str());
  }
  while (entries_.back().step > step) entries_.pop_back();
  filter.restore(entries_.back().snapshot);
  return entries_.back().step;
}

std::size_t SnapshotRing::bytes() const {
  std::size_t total = 0;
  for (const Entry& entry : entries_) total += entry.snapshot.bytes();
  return total;
}

}  // namespace helixnav::cekf
