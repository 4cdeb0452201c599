// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <set>
#include <sstream>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "matrices/make_room.hpp"
#include "update/iterate_and_apply.hpp"

namespace helixnav::cekf {
namespace {

constexpr int max_iterations = 50;

void name_pairs(const std::vector<CompressedEkf::LandmarkPair>& pairs, UpdateWorkspace& w) {
  std::vector<Match> as_matches;
  for (const auto& [kept, removed] : pairs) {
    as_matches.push_back({kept, {}, {}});
    as_matches.push_back({removed, {}, {}});
  }
  name_landmarks(as_matches, w);
}

}  // namespace

UpdateResult CompressedEkf::merge(const std::vector<LandmarkPair>& kept_removed, double sigma_m) {
  check_pairs(kept_removed, sigma_m, "merge");
  if (kept_removed.empty()) return {};
  make_room(active_.dead_slots, kept_removed.size());  // what follows the update must not throw
  BeforeActivations before = before_activations(false);
  UpdateResult result;
  try {
    for (const auto& [kept, removed] : kept_removed) {
      activate(kept);
      activate(removed);
    }
    name_pairs(kept_removed, workspace_);
    result = iterate_and_apply(max_iterations, "merge", [&](UpdateWorkspace& w) { linearise_pairs(sigma_m, w); });
  } catch (...) {
    undo_activations(before);
    throw;
  }
  for (const LandmarkPair& pair : kept_removed) remove(pair.second);
  return result;
}

CostByPart CompressedEkf::merge_cost(const std::vector<LandmarkPair>& kept_removed, double sigma_m) const {
  check_pairs(kept_removed, sigma_m, "merge_cost");
  if (kept_removed.empty()) return {};
  UpdateWorkspace w;
  name_pairs(kept_removed, w);
  gather_involved_unactivated(w);
  InvolvedCorrection correction(options_.retraction, w);
  const double cost = iterate_to_minimum(correction, w, max_iterations, "merge_cost",
                                         [&](UpdateWorkspace& at) { linearise_pairs(sigma_m, at); });
  if (!std::isfinite(cost)) return {cost, static_cast<int>(w.nu.rows()), {}};
  return {cost, static_cast<int>(w.nu.rows()), cost_by_part(w, std::vector<int>(kept_removed.size(), 2))};
}

/// A landmark may be kept for several others, but goes only once and cannot both go and stay.
void CompressedEkf::check_pairs(const std::vector<LandmarkPair>& kept_removed, double sigma_m, const char* verb) const {
  std::set<core::LandmarkId> kept;
  std::set<core::LandmarkId> removed;
  for (const LandmarkPair& pair : kept_removed) {
    place_of(pair.first, verb);
    place_of(pair.second, verb);
    kept.insert(pair.first);
    const bool fresh = removed.insert(pair.second).second;
    if (!fresh || kept.count(pair.second) > 0 || removed.count(pair.first) > 0) {
      std::ostringstream problem;
      problem << verb << ": pair (" << pair.first << ", " << pair.second << ") contradicts another or itself";
      throw core::PreconditionError(problem.str());
    }
  }
  if (!(sigma_m >= 0.0) || !std::isfinite(sigma_m)) {
    throw core::PreconditionError(std::string(verb) + ": sigma_m must be finite and not negative");
  }
}

}  // namespace helixnav::cekf
