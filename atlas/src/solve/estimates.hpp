// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "phase/rigid_fit.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// Values of the variables a node eliminates, given those of its boundary: x = g(lin + L₁₁⁻ᵀ(s·y − L₂₁ᵀe)), s the share of the
/// step to the solution.
Values solve_down(const State& state, const FrontShape& shape, const Front& front, const Motion& boundary,
                  double share = 1.0);

/// Estimates as they follow from the top of the tree. Settling leaves alone those parts of the map that have moved as a whole;
/// their values are brought up to date here on request, one path at a time, and the state stays as it is.
class Estimates {
 public:
  explicit Estimates(const State& state) : state_(state) {}

  /// Brings a node and all above it up to date.
  void reach(int node);
  /// Brings up to date a node whose parent was reached.
  void update(int node);
  /// Brings the whole tree up to date, or a subtree whose parent was reached.
  void update_all(int node);

  /// Of a variable whose node was reached, or that no node has yet.
  const Eigen::Vector3d& operator()(int variable) const;
  /// After reach(at).
  const Eigen::Vector3d& of(int variable);

  Values of_boundary(int node) const;

  /// Writes the values that were brought up to date.
  void store(State& state) const;

 private:
  const State& state_;
  std::unordered_map<int, Eigen::Vector3d> moved_;
  std::unordered_set<int> reached_;
  std::vector<int> changed_;  // nodes, in the order they were brought up to date
};

}  // namespace helixnav::atlas
