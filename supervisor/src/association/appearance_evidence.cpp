// SPDX-License-Identifier: BSD-3-Clause
#include "association/appearance_evidence.hpp"

#include <algorithm>

namespace helixnav::supervisor {
namespace {

const core::Appearance& appearance_of(const core::Scan& scan, const core::AssociationReport& association) {
  return scan.observations[static_cast<std::size_t>(association.observation)].appearance;
}

bool tells_appearance(const core::Scan& scan) {
  return std::any_of(scan.observations.begin(), scan.observations.end(),
                     [](const core::Observation& one) { return one.appearance.is_given(); });
}

}  // namespace

std::vector<double> appearance_nats(const core::MapAppearance& appearance, const core::Scan& scan,
                                    const std::vector<core::AssociationReport>& associations) {
  std::vector<double> nats;
  if (appearance.is_empty() || !tells_appearance(scan)) return nats;
  for (const core::AssociationReport& association : associations) {
    if (association.outcome != core::Outcome::matched || association.landmark == core::no_landmark) continue;
    nats.push_back(appearance.compare(association.landmark, appearance_of(scan, association)).nats);
  }
  return nats;
}

void look_at(const core::Scan& scan, const std::vector<core::AssociationReport>& associations,
             association::LandmarkLife& existence) {
  if (!tells_appearance(scan)) return;
  for (const core::AssociationReport& association : associations) {
    const bool is_known =
        association.outcome == core::Outcome::matched || association.outcome == core::Outcome::augmented;
    existence.look(is_known ? association.landmark : core::no_landmark, appearance_of(scan, association));
  }
}

}  // namespace helixnav::supervisor
