// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "association/old_pairs.hpp"

namespace helixnav::supervisor {

/// Matchings at other poses than that of `best`, each once, in a fixed order. Found from any two pairs of eight
/// observations spread over the scan that are jointly compatible (99.9 %); a pose that matches half of the scan has two of
/// the eight in 96 of 100. One that shares half of its pairs with the best matching is at the same pose: what differs there
/// is for the assignment to decide. One of fewer than half as many pairs is no rival. Nothing where more than 2000 pairs of
/// pairs would have to be tried.
/// Test: supervisor/association/place_evidence_test.cpp (a lattice; all matchings enumerated).
std::optional<std::vector<Matching>> rival_matchings(const OldPairs& old, const Matching& best);

}  // namespace helixnav::supervisor
