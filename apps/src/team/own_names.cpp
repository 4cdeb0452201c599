// SPDX-License-Identifier: BSD-3-Clause
#include "team/own_names.hpp"

namespace helixnav::apps {

std::vector<std::int64_t> OwnNames::take(const core::Event& event) {
  const std::optional<core::StepReport> report = navigator_.take(event);
  std::vector<std::int64_t> names;
  if (!report) return names;
  for (const core::AssociationReport& association : report->associations) {
    const bool told = association.outcome == core::Outcome::matched || association.outcome == core::Outcome::augmented;
    names.push_back(told ? association.landmark : -1);
  }
  return names;
}

}  // namespace helixnav::apps
