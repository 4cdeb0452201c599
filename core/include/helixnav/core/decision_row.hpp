// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/decision.hpp"

namespace helixnav::core {

/// A decision as a row of decisions.csv: `kind` and `verdict` are words, `numbers` are named with units and kept in order.
struct DecisionRow {
  std::string kind;
  std::string verdict;
  std::vector<std::pair<std::string, double>> numbers;
};

/// The one place that knows what a decision's row looks like. Test: core/decision_row_test.cpp (there and back).
DecisionRow row_of(const Decision& decision);

/// The decision of a row; numbers that the row lacks keep their defaults, names of earlier versions are
/// understood. A kind or verdict that is not known comes back as OtherDecision.
Decision decision_of(const DecisionRow& row);

}  // namespace helixnav::core
