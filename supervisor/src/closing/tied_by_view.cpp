// SPDX-License-Identifier: BSD-3-Clause
#include "closing/tied_by_view.hpp"

#include <cstddef>
#include <unordered_map>
#include <variant>

namespace helixnav::supervisor {

double tied_since_m(const Tape& tape, double path_m, double gap_m) {
  std::vector<double> driven_m{0.0};  // at each scan, the beginning of the tape first
  std::vector<int> change{0};         // of how many landmarks reach from a scan to the next, against the next
  std::unordered_map<core::LandmarkId, std::size_t> last_seen;
  tape.read_from(0, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) driven_m.back() += motion->driven_m;
    const auto* scan = std::get_if<Tape::Scan>(&entry);
    if (scan == nullptr) return;
    const std::size_t now = driven_m.size() - 1;
    for (const core::AssociationReport& a : scan->fate) {
      if (a.outcome != core::Outcome::matched && a.outcome != core::Outcome::augmented) continue;
      const auto [seen, is_first] = last_seen.try_emplace(a.landmark, now);
      if (!is_first && driven_m[now] - driven_m[seen->second] <= gap_m) {
        ++change[now];
        --change[seen->second];
      }
      seen->second = now;
    }
    driven_m.push_back(driven_m.back());
    change.push_back(0);
  });
  constexpr int enough = 2;  // landmarks fix a pose
  int across = 0;
  bool tied = false;
  for (std::size_t k = change.size(); k-- > 0;) {
    across += change[k];
    if (tied && across < enough) return path_m - (driven_m.back() - driven_m[k]);
    tied = tied || across >= enough;
  }
  return path_m;  // never two at once
}

std::vector<core::LandmarkId> seen_since(double path_m, const association::LandmarkLife& life,
                                         const std::vector<core::LandmarkId>& ids) {
  std::vector<core::LandmarkId> since;
  for (const core::LandmarkId id : ids) {
    if (life.contains(id) && life.record(id).last_seen_path_m > path_m) since.push_back(id);
  }
  return since;
}

}  // namespace helixnav::supervisor
