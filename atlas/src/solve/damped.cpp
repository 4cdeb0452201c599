// SPDX-License-Identifier: BSD-3-Clause
#include "solve/damped.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "phase/world_form.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"

namespace helixnav::atlas {
namespace {

/// All nodes, parents before children.
std::vector<int> nodes_downwards(const State& state) {
  std::vector<int> nodes{state.root};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const TreeNode& node = state.node(nodes[i]);
    if (node.phase < 0) nodes.insert(nodes.end(), node.child.begin(), node.child.end());
  }
  return nodes;
}

/// χ² of a part at the present values, above what it was where the part was derived.
double excess_of(const State& state, const Part& part) {
  Values values;
  for (const int v : part.variables) values.push_back(state.value(v));
  const RelativeGaussian& g = *part.gaussian;
  Eigen::VectorXd delta = relative_coordinates(values) - g.mean;
  delta[2] = core::wrap_to_pi(delta[2]);
  return delta.dot(g.information * delta) - 2.0 * g.vector.dot(delta);
}

/// Where Cauchy's cost begins to bend: far above what noise makes of a part.
double scale_of(const Part& part) { return 25.0 * static_cast<double>(part.gaussian->mean.size()); }

/// Cauchy's cost: what was torn apart by a closing pulls the less the farther.
double cost_of(const State& state) {
  double cost = 0.0;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    for (const Part& part : state.phases[k]->parts) {
      const double scale = scale_of(part);
      cost += scale * std::log1p(std::max(0.0, excess_of(state, part)) / scale);
    }
  }
  return cost;
}

/// Gives every part the weight with which its own cost goes on as Cauchy's does here. The least of them, and χ² so weighed.
struct Weighed {
  double least = 1.0;
  double chi2 = 0.0;
};
Weighed weigh(State& state) {
  Weighed weighed;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    Leaf leaf = *state.phases[k];
    for (Part& part : leaf.parts) {
      const double excess = excess_of(state, part);
      part.weight = 1.0 / (1.0 + std::max(0.0, excess) / scale_of(part));
      weighed.least = std::min(weighed.least, part.weight);
      weighed.chi2 += part.weight * (part.gaussian->chi2 + excess);
    }
    state.phases.write(k) = std::make_shared<const Leaf>(std::move(leaf));
  }
  return weighed;
}

void unweigh(State& state) {
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    Leaf leaf = *state.phases[k];
    for (Part& part : leaf.parts) part.weight = 1.0;
    state.phases.write(k) = std::make_shared<const Leaf>(std::move(leaf));
  }
}

/// Estimates at a share of the step from where all fronts were linearised.
void step(State& state, const std::vector<int>& nodes, double share) {
  for (const int id : nodes) {
    const FrontShape& shape = *state.node(id).shape;
    const Values values = solve_down(state, shape, *state.node(id).front, motion_of_boundary(state, id), share);
    for (std::size_t i = 0; i < values.size(); ++i) state.values.write(State::index(shape.variables[i])) = values[i];
  }
}

/// Goes so much of the way that the cost falls by a tenth of what the linear problem promises; returns what was promised.
double step_down(State& state, const std::vector<int>& nodes, double chi2) {
  constexpr double least_kept = 0.1, smallest_share = 1e-4, rounding = 1e-9;
  const double promised = chi2 - state.node(state.root).front->message.back();
  const PersistentVector<Eigen::Vector3d> begun = state.values;
  const double before = cost_of(state);
  for (double share = 1.0; share > smallest_share; share *= 0.5) {
    step(state, nodes, share);
    if (before - cost_of(state) > least_kept * (2.0 - share) * share * promised - rounding * chi2) return promised;
    state.values = begun;
  }
  throw core::NumericalError("atlas: no step from where the map is brings it nearer to its measurements");
}

}  // namespace

void damp(State& state, int& redone) {
  constexpr double near = 1.0;  // of a χ² of a thousand and more
  constexpr double no_longer_torn = 0.5;
  finish_descent(state);
  Estimates estimates(state);
  estimates.update_all(state.root);
  estimates.store(state);
  const std::vector<int> nodes = nodes_downwards(state);
  state.rounds = 0;
  for (int round = 0; round < state.options.max_rounds; ++round) {
    const Weighed weighed = weigh(state);
    for (const int id : nodes) state.nodes.write(State::index(id)).dirty = true;
    redo_dirty(state, redone, {});
    const double promised = step_down(state, nodes, weighed.chi2);
    if (promised > near || weighed.least < no_longer_torn) continue;
    unweigh(state);
    for (const int id : nodes) state.nodes.write(State::index(id)).dirty = true;
    return;
  }
  throw core::NumericalError("atlas: not settled after " + std::to_string(state.options.max_rounds) + " damped rounds");
}

}  // namespace helixnav::atlas
