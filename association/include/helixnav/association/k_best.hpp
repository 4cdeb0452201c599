// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/linear_assignment.hpp"

namespace helixnav::association {

/// The k cheapest assignments, cheapest first; fewer if there are not that many. Murty's partition (1968); each part is
/// solved by one shortest path from its parent's prices. Cost O(k × rows) paths.
/// Throws PreconditionError for k < 1 and as solve_assignment does.
/// Test: association/k_best_test.cpp (enumeration of all assignments).
std::vector<AssignmentSolution> k_best_assignments(const AssignmentProblem& problem, int k);

}  // namespace helixnav::association
