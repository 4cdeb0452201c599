// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "read/read.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"
#include "tree/front_shape.hpp"

namespace helixnav::atlas {
namespace {

std::vector<int> leaves_of(const State& state, int variable) {
  std::vector<int> leaves;
  for (const int phase : *state.phases_of[State::index(variable)]) {
    leaves.push_back(state.leaf_of_phase[State::index(phase)]);
  }
  return leaves;
}

/// Values on all paths that will change.
void bring_nodes_along(State& state, const std::vector<int>& nodes) {
  Estimates estimates(state);
  for (const int node : nodes) estimates.reach(node);
  estimates.store(state);
}

void rename(State& state, int phase, int from, int to) {
  Leaf leaf = state.leaf(phase);
  for (Part& part : leaf.parts) std::replace(part.variables.begin(), part.variables.end(), from, to);
  state.phases.write(State::index(phase)) = std::make_shared<const Leaf>(std::move(leaf));
}

void merge_variables(State& state, int gone, int kept) {
  std::vector<int> touched = leaves_of(state, gone);
  for (const int leaf : leaves_of(state, kept)) touched.push_back(leaf);
  bring_nodes_along(state, touched);
  for (const int phase : *state.phases_of[State::index(gone)]) rename(state, phase, gone, kept);
  auto phases = std::make_shared<std::vector<int>>();
  const auto& of_gone = *state.phases_of[State::index(gone)];
  const auto& of_kept = *state.phases_of[State::index(kept)];
  std::set_union(of_gone.begin(), of_gone.end(), of_kept.begin(), of_kept.end(), std::back_inserter(*phases));
  state.variables.write(State::index(kept)).leaves = static_cast<int>(phases->size());
  state.phases_of.write(State::index(kept)) = std::move(phases);
  state.phases_of.write(State::index(gone)) = std::make_shared<const std::vector<int>>();
  Variable& empty = state.variables.write(State::index(gone));
  empty.leaves = 0;
  empty.at = -1;
  empty.name = -1;
  shape_paths(state, touched);
}

}  // namespace

void Atlas::merge(const std::vector<MergePair>& pairs) {
  for (const auto& [gone, kept] : pairs) {
    if (variable_of_named(*working_, gone) == variable_of_named(*working_, kept)) {
      throw core::PreconditionError("atlas: landmarks " + std::to_string(gone) + " and " + std::to_string(kept) +
                                    " are one already");
    }
  }
  finish_descent(*working_);
  for (const auto& [gone, kept] : pairs) {
    const int v = working_->variable_of_landmark[State::index(gone)];
    const int to = working_->variable_of_landmark[State::index(kept)];
    if (v == to) continue;  // merged by an earlier pair
    merge_variables(*working_, v, to);
    for (std::size_t id = 0; id < working_->variable_of_landmark.size(); ++id) {
      if (working_->variable_of_landmark[id] == v) working_->variable_of_landmark.write(id) = to;
    }
  }
}

MergeCost Atlas::merge_cost(const std::vector<MergePair>& pairs) const {
  if (!is_settled()) throw core::PreconditionError("atlas: merge_cost of a map that is not settled");
  Atlas merged(*this);
  merged.merge(pairs);
  merged.settle();
  return {merged.chi2() - chi2(), 2 * static_cast<int>(pairs.size())};
}

}  // namespace helixnav::atlas
