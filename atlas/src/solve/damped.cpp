// SPDX-License-Identifier: BSD-3-Clause
#include "solve/damped.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

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

/// χ² of a part at the present values.
double chi2_of(const State& state, const Part& part) {
  Values values;
  for (const int v : part.variables) values.push_back(state.value(v));
  const RelativeGaussian& g = *part.gaussian;
  Eigen::VectorXd delta = relative_coordinates(values) - g.mean;
  delta[2] = core::wrap_to_pi(delta[2]);
  return g.chi2 + delta.dot(g.information.full() * delta) - 2.0 * g.vector.dot(delta);
}

/// The least χ² that a part can have. It may have more where it was derived: a fix that came where the map was wrong, a phase derived
/// while the map bent it.
double least_chi2_of(const RelativeGaussian& g) {
  return g.chi2 - g.vector.dot(g.information.full().ldlt().solve(g.vector));
}

/// least_chi2_of all parts, phase after phase.
using LeastChi2 = std::vector<std::vector<double>>;

LeastChi2 least_chi2(const State& state) {
  LeastChi2 least;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    least.emplace_back();
    for (const Part& part : state.phases[k]->parts) least.back().push_back(least_chi2_of(*part.gaussian));
  }
  return least;
}

/// Where Cauchy's cost begins to bend: far above the χ² that noise gives a part.
double scale_of(const Part& part) { return 25.0 * static_cast<double>(part.gaussian->mean.size()); }

/// Cauchy's cost: the farther a loop closure has torn something apart, the less it pulls.
double cost_of(const State& state, const LeastChi2& least) {
  double cost = 0.0;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    const std::vector<Part>& parts = state.phases[k]->parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const double scale = scale_of(parts[p]);
      cost += scale * std::log1p(std::max(0.0, chi2_of(state, parts[p]) - least[k][p]) / scale);
    }
  }
  return cost;
}

/// Gives every part the weight with which its own cost continues as Cauchy's does here. The least weight, and χ² so weighted.
struct Weighed {
  double least = 1.0;
  double chi2 = 0.0;
};
Weighed weigh(State& state, const LeastChi2& least) {
  Weighed weighed;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    Leaf leaf = *state.phases[k];
    for (std::size_t p = 0; p < leaf.parts.size(); ++p) {
      Part& part = leaf.parts[p];
      const double chi2 = chi2_of(state, part);
      part.weight = 1.0 / (1.0 + std::max(0.0, chi2 - least[k][p]) / scale_of(part));
      weighed.least = std::min(weighed.least, part.weight);
      weighed.chi2 += part.weight * chi2;
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

/// By how much the step that the fronts propose would lower χ² if everything were linear.
double promise_of(const State& state, double chi2) { return chi2 - state.node(state.root).front->message.back(); }

/// Takes a step short enough for the cost to fall by a tenth of what the linear problem promises. False, with everything as before, if
/// there is none.
template <class Cost>
bool step_down(State& state, const std::vector<int>& nodes, double chi2, const Cost& cost) {
  constexpr double least_kept = 0.1, smallest_share = 1e-4, rounding = 1e-9;
  const double promised = promise_of(state, chi2);
  const PersistentVector<Eigen::Vector3d> begun = state.values;
  const double before = cost();
  for (double share = 1.0; share > smallest_share; share *= 0.5) {
    step(state, nodes, share);
    if (before - cost() > least_kept * (2.0 - share) * share * promised - rounding * chi2) return true;
    state.values = begun;
  }
  return false;
}

void linearise_all_here(State& state, const std::vector<int>& nodes, int& redone) {
  for (const int id : nodes) state.nodes.write(State::index(id)).dirty = true;
  redo_dirty(state, redone, {});
}

double chi2_of_all(const State& state) {
  double chi2 = 0.0;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    for (const Part& part : state.phases[k]->parts) chi2 += chi2_of(state, part);
  }
  return chi2;
}

}  // namespace

void damp(State& state, int& redone) {
  constexpr double near = 1.0;  // out of a χ² of a thousand and more
  constexpr double no_longer_torn = 0.5;
  finish_descent(state);
  Estimates estimates(state);
  estimates.update_all(state.root);
  estimates.store(state);
  const std::vector<int> nodes = nodes_downwards(state);
  const LeastChi2 least = least_chi2(state);
  state.rounds = 0;
  for (int round = 0; round < state.options.max_rounds; ++round) {
    const Weighed weighed = weigh(state, least);
    linearise_all_here(state, nodes, redone);
    const double promised = promise_of(state, weighed.chi2);
    if (!step_down(state, nodes, weighed.chi2, [&] { return cost_of(state, least); })) {
      throw core::NumericalError("atlas: no step from where the map is brings it nearer to its measurements");
    }
    if (promised > near || weighed.least < no_longer_torn) continue;
    unweigh(state);
    for (const int id : nodes) state.nodes.write(State::index(id)).dirty = true;
    return;
  }
  throw core::NumericalError("atlas: not settled after " + std::to_string(state.options.max_rounds) + " damped rounds");
}

void settle_damped(State& state, int& redone) {
  constexpr double near = 1e-3, enough = 1.0;  // of χ²
  const std::vector<int> nodes = nodes_downwards(state);
  double promised = 0.0;
  for (int round = 0; round < state.options.max_rounds; ++round) {
    linearise_all_here(state, nodes, redone);
    const double chi2 = chi2_of_all(state);
    promised = promise_of(state, chi2);
    if (promised < near || !step_down(state, nodes, chi2, [&] { return chi2_of_all(state); })) break;
  }
  if (promised > enough) throw core::NumericalError("atlas: not settled by shortened steps either");
  for (const int id : nodes) state.nodes.write(State::index(id)).dirty = true;
  linearise_in_place(state);
  state.to_open.clear();
  state.descending = false;
  state.rounds = 0;
}

}  // namespace helixnav::atlas
