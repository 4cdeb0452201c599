// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "phase/rigid_fit.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// Memory for one front, used again and again.
class Workspace {
 public:
  /// A square of zeros below and on the diagonal; what it held is gone.
  Eigen::Map<Eigen::MatrixXd> zero_square(Eigen::Index rows);

 private:
  std::vector<double> buffer_;
};

/// The variable that stays where it is: the last pose that the root eliminates. Any pose would give the same map; one that both
/// halves of the drive share is tied best to either.
int gauge_of(const State& state);

/// Forms the front of a node at the present values, from its leaf or its children's messages, eliminates, and stores
/// the result; the node is clean and fresh. NumericalError, naming a variable, when it is not positive definite.
void eliminate(State& state, int node, Workspace& workspace);

/// Adds a child's message to its parent's front where the present values have it, `motion` away from where it was linearised.
/// `offsets`: row there of each boundary variable.
void add_message(const State& state, int child, const Motion& motion, const std::vector<int>& offsets,
                 Eigen::Map<Eigen::MatrixXd> F);

}  // namespace helixnav::atlas
