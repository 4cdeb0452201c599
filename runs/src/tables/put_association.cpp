// SPDX-License-Identifier: BSD-3-Clause
#include "put_association.hpp"

#include <algorithm>

namespace helixnav::runs {

void put_association(std::int64_t step, const core::AssociationReport& association,
                     std::vector<core::StepReport>& steps) {
  const auto at = std::lower_bound(steps.begin(), steps.end(), step,
                                   [](const core::StepReport& s, std::int64_t number) { return s.step < number; });
  if (at == steps.end() || at->step != step) return;
  auto& associations = at->associations;
  const auto known =
      std::lower_bound(associations.begin(), associations.end(), association.observation,
                       [](const core::AssociationReport& a, int observation) { return a.observation < observation; });
  if (known != associations.end() && known->observation == association.observation) {
    *known = association;
  } else {
    associations.insert(known, association);
  }
}

}  // namespace helixnav::runs
