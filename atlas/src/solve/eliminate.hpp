// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "phase/rigid_fit.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// Memory for one front, reused.
class Workspace {
 public:
  /// A square of zeros on and below the diagonal; its previous contents are lost.
  Eigen::Map<Eigen::MatrixXd> zero_square(Eigen::Index rows);

 private:
  std::vector<double> buffer_;
};

/// The variable that is held fixed: the last pose that the root eliminates. Any pose would give the same map; one shared by
/// both halves of the drive is tied best to either.
int gauge_of(const State& state);

/// Forms the front of a node at the current values, from its leaf or its children's messages, eliminates, and stores
/// the result; the node is then clean and fresh. NumericalError, naming a variable, when it is not positive definite.
void eliminate(State& state, int node, Workspace& workspace);

/// Adds a child's message to its parent's front at the current values, `motion` away from where it was linearised. `offsets`:
/// row there of each boundary variable.
void add_message(const State& state, int child, const Motion& motion, const std::vector<int>& offsets,
                 Eigen::Map<Eigen::MatrixXd> F);

}  // namespace helixnav::atlas
