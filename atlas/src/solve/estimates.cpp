// SPDX-License-Identifier: BSD-3-Clause
#include "solve/estimates.hpp"

#include <memory>
#include <utility>

#include <Eigen/Core>

namespace helixnav::atlas {

Values solve_down(const State& state, const FrontShape& shape, const Front& front, const Motion& boundary,
                  double share) {
  Values values;
  if (shape.ne == 0) return values;
  Eigen::VectorXd y = share * front.L.bottomRows<1>().transpose();
  if (boundary.rest.size() > 0) y.noalias() -= front.L.middleRows(shape.ne, shape.nb).transpose() * boundary.rest;
  front.L.topRows(shape.ne).triangularView<Eigen::Lower>().transpose().solveInPlace(y);
  for (int i = 0; i < shape.eliminated; ++i) {
    const int dim = state.variable(shape.variables[State::index(i)]).dim;
    Eigen::Vector3d value = front.linearised_at[State::index(i)];
    value.head(dim) += y.segment(shape.offsets[State::index(i)], dim);
    values.push_back(boundary.rigid(value, dim));
    if (dim == 3) values.back()[2] = core::wrap_to_pi(values.back()[2]);
  }
  return values;
}

void Estimates::reach(int node) {
  std::vector<int> path;
  for (; node >= 0 && reached_.count(node) == 0; node = state_.node(node).parent) path.push_back(node);
  for (std::size_t i = path.size(); i-- > 0;) update(path[i]);
}

void Estimates::update(int id) {
  if (!reached_.insert(id).second) return;
  const TreeNode& node = state_.node(id);
  if (node.dirty || node.front == nullptr || node.shape->eliminated == 0) return;
  const Values boundary = of_boundary(id);
  if (node.opened_at != nullptr && *node.opened_at == boundary) return;
  const FrontShape& shape = *node.shape;
  const Motion motion =
      motion_of(state_, shape, shape.eliminated, node.front->linearised_at.data() + shape.eliminated, boundary);
  const Values values = solve_down(state_, shape, *node.front, motion);
  for (std::size_t i = 0; i < values.size(); ++i) moved_[shape.variables[i]] = values[i];
  changed_.push_back(id);
}

void Estimates::update_all(int id) {
  update(id);
  if (state_.is_leaf(id)) return;
  for (const int child : state_.node(id).child) update_all(child);
}

const Eigen::Vector3d& Estimates::operator()(int variable) const {
  const auto found = moved_.find(variable);
  return found == moved_.end() ? state_.value(variable) : found->second;
}

const Eigen::Vector3d& Estimates::of(int variable) {
  reach(state_.variable(variable).at);
  return (*this)(variable);
}

Values Estimates::of_boundary(int id) const {
  const FrontShape& shape = *state_.node(id).shape;
  Values values;
  for (std::size_t i = State::index(shape.eliminated); i < shape.variables.size(); ++i) {
    values.push_back((*this)(shape.variables[i]));
  }
  return values;
}

void Estimates::store(State& state) const {
  for (const int id : changed_) {
    const FrontShape& shape = *state.node(id).shape;
    for (int i = 0; i < shape.eliminated; ++i) {
      const int v = shape.variables[State::index(i)];
      state.values.write(State::index(v)) = (*this)(v);
    }
    state.nodes.write(State::index(id)).opened_at = std::make_shared<const Values>(of_boundary(id));
  }
}

}  // namespace helixnav::atlas
