// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "factors.hpp"

namespace helixnav::smoothing {

/// Where each variable is among the columns of H: free poses first (3 each), then landmarks (2 each).
struct Layout {
  std::vector<int> pose_column;  ///< −1 when fixed
  std::vector<int> landmark_column;
  int columns = 0;
};

Layout make_layout(const Problem& problem);

/// Name of the variable that a column belongs to.
std::string name_of_column(const Problem& problem, const Layout& layout, int column);

/// state + step, headings wrapped.
void add_step(const Layout& layout, const Eigen::VectorXd& step, const State& from, State& to);

}  // namespace helixnav::smoothing
