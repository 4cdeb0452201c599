// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {

/// Of a set of pairs whose joint covariance is not positive definite; names the landmarks.
[[noreturn]] inline void throw_not_positive_definite(const InnovationProblem& problem, const std::vector<int>& pairs) {
  std::string landmarks;
  for (const int p : pairs) landmarks += " " + std::to_string(problem.ids[problem.pairs[p].candidate]);
  throw core::NumericalError("joint innovation covariance is not positive definite for landmarks" + landmarks);
}

}  // namespace helixnav::association
