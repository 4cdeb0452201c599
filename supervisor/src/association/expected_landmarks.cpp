// SPDX-License-Identifier: BSD-3-Clause
#include "association/expected_landmarks.hpp"

#include <algorithm>

#include "association/association_report.hpp"
#include "association/candidates.hpp"

namespace helixnav::supervisor {

using core::LandmarkId;
using core::Outcome;

std::vector<LandmarkId> expected_unseen(const cekf::CompressedEkf& filter, const core::Scan& scan, double margin_m,
                                        const std::vector<core::AssociationReport>& associations) {
  std::vector<LandmarkId> expected = expected_in_view(filter, scan, margin_m);
  for (const Outcome no_miss : {Outcome::ambiguous, Outcome::rejected, Outcome::augmented}) {
    for (const LandmarkId id : landmarks_with(no_miss, associations)) {
      expected.erase(std::remove(expected.begin(), expected.end(), id), expected.end());
    }
  }
  return expected;
}

std::vector<LandmarkId> unseen_at_rim(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                      const std::vector<core::AssociationReport>& associations,
                                      const std::vector<LandmarkId>& expected) {
  std::vector<LandmarkId> unseen = expected_unseen(filter, scan, 0.0, associations);
  const std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, associations);
  for (const std::vector<LandmarkId>* others : {&expected, &seen}) {
    for (const LandmarkId id : *others) unseen.erase(std::remove(unseen.begin(), unseen.end(), id), unseen.end());
  }
  return unseen;
}

void drop_what_may_be_elsewhere(const association::LandmarkLife& existence, const Search* open, double old_after_m,
                                const std::vector<LandmarkId>& seen, std::vector<LandmarkId>& expected) {
  const double old_before_m = existence.path_m() - old_after_m;
  const auto recognised = std::count_if(seen.begin(), seen.end(),
                                        [&](LandmarkId id) { return existence.record(id).born_path_m < old_before_m; });
  constexpr int enough = 2;
  const auto may_be_elsewhere = [&](LandmarkId id) {
    if (open != nullptr && open->excludes(id)) return true;
    return recognised < enough && existence.record(id).last_seen_path_m < old_before_m;
  };
  expected.erase(std::remove_if(expected.begin(), expected.end(), may_be_elsewhere), expected.end());
}

}  // namespace helixnav::supervisor
