// SPDX-License-Identifier: BSD-3-Clause
#include "integrity/integrity_monitor.hpp"

#include <algorithm>
#include <iterator>

namespace helixnav::supervisor {
namespace {

std::vector<core::LandmarkId> united(std::vector<core::LandmarkId> a, const std::vector<core::LandmarkId>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

}  // namespace

void IntegrityMonitor::observe(const association::LandmarkLife& life, const std::vector<core::LandmarkId>& expected,
                               const std::vector<core::LandmarkId>& matched, double old_after_m) {
  const double path_m = life.path_m();
  int looks = 0;
  int hits = 0;
  for (const core::LandmarkId id : united(expected, matched)) {
    Returned* one = find_returned(life, id, old_after_m);
    if (one == nullptr) continue;
    const bool hit = std::find(matched.begin(), matched.end(), id) != matched.end();
    ++one->looks;
    one->hits += hit;
    one->last_look_path_m = path_m;
    ++looks;
    hits += hit;
  }
  constexpr int enough = 2;
  const bool confirmed = hits >= enough && hits_before_ >= enough;
  hits_before_ = hits;
  clear_ = confirmed || (clear_ && looks == 0);
  if (clear_ || !clear_path_m_) clear_path_m_ = path_m;
  for (auto it = returned_.begin(); it != returned_.end();) {
    if (confirmed) it->second.looks = it->second.hits = 0;
    const bool forgotten = clear_ && path_m - it->second.last_look_path_m > old_after_m;
    it = forgotten ? returned_.erase(it) : std::next(it);
  }
}

void IntegrityMonitor::close(double path_m, const std::vector<core::LandmarkId>& recognised) {
  *this = IntegrityMonitor();
  clear_path_m_ = path_m;
  for (const core::LandmarkId id : recognised) returned_[id].last_look_path_m = path_m;
}

IntegrityMonitor::Returned* IntegrityMonitor::find_returned(const association::LandmarkLife& life, core::LandmarkId id,
                                                            double old_after_m) {
  const auto known = returned_.find(id);
  if (known != returned_.end()) return &known->second;
  const association::LandmarkRecord& record = life.record(id);
  const bool old = life.path_m() - record.last_seen_path_m > old_after_m;
  return old && record.state == core::LandmarkState::mature ? &returned_[id] : nullptr;
}

IntegrityMonitor::Evidence IntegrityMonitor::evidence(const association::LandmarkLife& life,
                                                      const IntegrityLimits& limits) const {
  Evidence evidence;
  for (const auto& [id, one] : returned_) {
    if (one.looks < limits.looks) continue;
    if (5 * one.hits <= one.looks) {
      ++evidence.missing;
    } else if (2 * one.hits >= one.looks) {
      ++evidence.seen;
    }
  }
  for (const association::LandmarkRecord& record : life.records()) {
    evidence.spawned +=
        clear_path_m_ && record.born_path_m > *clear_path_m_ && record.state == core::LandmarkState::mature;
  }
  evidence.nats = limits.missing_nats * evidence.missing - limits.seen_nats * evidence.seen;
  return evidence;
}

bool IntegrityMonitor::is_lost(const association::LandmarkLife& life, const IntegrityLimits& limits) const {
  if (limits.missing_nats * static_cast<double>(returned_.size()) < limits.nats) return false;
  const Evidence found = evidence(life, limits);
  return found.nats >= limits.nats && found.spawned >= limits.spawned;
}

}  // namespace helixnav::supervisor
