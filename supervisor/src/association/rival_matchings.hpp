// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "association/old_pairs.hpp"

namespace helixnav::supervisor {

/// Matchings at poses other than that of `best`, each once, in a fixed order. Found from any two jointly compatible
/// (99.9 %) pairs of eight observations spread over the scan; a pose that matches half of the scan matches two of the
/// eight in 96 of 100 cases. A matching that shares half of its pairs with the best one is at the same pose: the
/// differences are for the assignment to decide. One with fewer than half as many pairs is not a rival. Nothing if more
/// than 2000 pairs of pairs would have to be tried.
/// Test: supervisor/association/place_evidence_test.cpp (a lattice; all matchings enumerated).
std::optional<std::vector<Matching>> rival_matchings(const OldPairs& old, const Matching& best);

}  // namespace helixnav::supervisor
