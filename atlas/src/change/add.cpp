// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"
#include "tree/front_shape.hpp"
#include "tree/lay_out.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

void check_factor(const PhaseFactor& factor) {
  const std::vector<core::LandmarkId>& ids = factor.shape.ids;
  const Index n = 3 + 2 * static_cast<Index>(ids.size());
  const RelativeGaussian& g = factor.gaussian;
  const bool increasing = std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end();
  if (!increasing || (!ids.empty() && ids.front() < 0) || g.information.rows() != n || g.vector.size() != n ||
      g.mean.size() != n || !g.information.all_finite() || !g.vector.allFinite() || !g.mean.allFinite()) {
    throw core::PreconditionError(
        "atlas: the factor's names are not increasing, or its sizes do not fit, or it is not finite");
  }
}

int variable_of(const State& state, core::LandmarkId id) {
  return id < static_cast<int>(state.variable_of_landmark.size()) ? state.variable_of_landmark[State::index(id)] : -1;
}

/// Exit and new landmarks have to be determined by the phase when its entry and the known landmarks are given.
void check_determined(const State& state, const PhaseFactor& factor) {
  std::vector<Index> rows{0, 1, 2};
  std::vector<core::LandmarkId> born;
  for (std::size_t i = 0; i < factor.shape.ids.size(); ++i) {
    if (variable_of(state, factor.shape.ids[i]) >= 0) continue;
    rows.push_back(3 + 2 * static_cast<Index>(i));
    rows.push_back(4 + 2 * static_cast<Index>(i));
    born.push_back(factor.shape.ids[i]);
  }
  Eigen::MatrixXd A = factor.gaussian.information.full()(rows, rows);
  const Eigen::VectorXd scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  A = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> llt(A);
  if (llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() > 1e-6) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  const Eigen::VectorXd free = eigen.eigenvectors().col(0).cwiseAbs();
  std::string names;
  for (std::size_t i = 0; i < born.size(); ++i) {
    if (free.segment<2>(3 + 2 * static_cast<Index>(i)).maxCoeff() > 0.1) names += " " + std::to_string(born[i]);
  }
  throw core::NumericalError("atlas: the phase does not determine its exit or landmarks:" + names);
}

/// Mean and sum of squared distances of points from it.
struct Spread {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  double squared_m2 = 0.0;
};

Spread spread_of(const std::vector<Eigen::Vector2d>& points_m) {
  Spread spread;
  for (const Eigen::Vector2d& point_m : points_m) spread.mean_m += point_m / static_cast<double>(points_m.size());
  for (const Eigen::Vector2d& point_m : points_m) spread.squared_m2 += (point_m - spread.mean_m).squaredNorm();
  return spread;
}

double misfit_m2(const core::Pose2& T_b_a, const std::vector<Eigen::Vector2d>& a_m,
                 const std::vector<Eigen::Vector2d>& b_m) {
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < a_m.size(); ++i) sum_m2 += (b_m[i] - core::transform(T_b_a, a_m[i])).squaredNorm();
  return sum_m2 / static_cast<double>(a_m.size());
}

/// The least-squares rigid motion from a to b.
core::Pose2 fitted(const std::vector<Eigen::Vector2d>& a_m, const std::vector<Eigen::Vector2d>& b_m) {
  const Spread a = spread_of(a_m);
  const Spread b = spread_of(b_m);
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < a_m.size(); ++i) {
    const Eigen::Vector2d p = a_m[i] - a.mean_m;
    const Eigen::Vector2d q = b_m[i] - b.mean_m;
    along += p.dot(q);
    across += p.x() * q.y() - p.y() * q.x();
  }
  const double turn_rad = std::atan2(across, along);
  const Eigen::Vector2d shift_m = b.mean_m - core::rotation(turn_rad) * a.mean_m;
  return {shift_m.x(), shift_m.y(), turn_rad};
}

/// Where the phase begins: at the last clone or, if a drive comes back to landmarks with an error of more than half a metre, where these put it,
/// provided they agree with each other. The solution is then sought from a phase that is in its place and an earlier drive that is not. A phase that
/// sees the last landmarks of the drive and old ones tens of metres beside them stays where the drive has it: what fits both best may be turned by a
/// radian.
core::Pose2 start_of(const State& state, const PhaseFactor& factor, const core::Pose2& T_atlas_entry) {
  std::vector<Eigen::Vector2d> here_m, known_m;
  for (std::size_t i = 0; i < factor.shape.ids.size(); ++i) {
    const int v = variable_of(state, factor.shape.ids[i]);
    if (v < 0) continue;
    here_m.emplace_back(factor.gaussian.mean.segment<2>(3 + 2 * static_cast<Index>(i)));
    known_m.emplace_back(state.value(v).head<2>());
  }
  constexpr std::size_t least_known = 3;
  constexpr double most_off_m = 0.5, least_spread_m = 3.0;
  if (here_m.size() < least_known) return T_atlas_entry;
  const double off_m2 = misfit_m2(T_atlas_entry, here_m, known_m);
  const double spread_m2 = spread_of(here_m).squared_m2 / static_cast<double>(here_m.size());
  if (off_m2 < most_off_m * most_off_m || spread_m2 < least_spread_m * least_spread_m) return T_atlas_entry;
  constexpr double most_left = 0.25, most_turned_rad = 0.1;  // by what does not fit
  const core::Pose2 T_there = fitted(here_m, known_m);
  const double left_m2 = misfit_m2(T_there, here_m, known_m);
  const bool agree = left_m2 < std::min(most_left * off_m2, most_turned_rad * most_turned_rad * spread_m2);
  return agree ? T_there : T_atlas_entry;
}

/// Variables of the factor in its order, born where the shape puts them.
std::vector<int> variables_for(State& state, const PhaseFactor& factor) {
  const int entry = state.variable_of_clone.back();
  const core::Pose2 T_atlas_entry = start_of(state, factor, core::Pose2(Eigen::Vector3d(state.value(entry))));
  const core::Pose2 T_atlas_exit =
      core::compose(T_atlas_entry, core::Pose2(Eigen::Vector3d(factor.gaussian.mean.head<3>())));
  const int clone = static_cast<int>(state.variable_of_clone.size());
  state.variable_of_clone.push_back(add_variable(state, 3, clone, T_atlas_exit.vector()));
  std::vector<int> variables{entry, state.variable_of_clone.back()};
  for (std::size_t i = 0; i < factor.shape.ids.size(); ++i) {
    const core::LandmarkId id = factor.shape.ids[i];
    int v = variable_of(state, id);
    if (v < 0) {
      Eigen::Vector3d value = Eigen::Vector3d::Zero();
      value.head<2>() = core::transform(T_atlas_entry, factor.gaussian.mean.segment<2>(3 + 2 * static_cast<Index>(i)));
      v = add_variable(state, 2, id, value);
      while (static_cast<int>(state.variable_of_landmark.size()) <= id) state.variable_of_landmark.push_back(-1);
      state.variable_of_landmark.write(State::index(id)) = v;
    }
    variables.push_back(v);
  }
  return variables;
}

/// The start, if it is uncertain: a factor of the first clone relative to the map frame.
Part start_part(const State& state) {
  auto gaussian = std::make_shared<RelativeGaussian>();
  gaussian->information = state.start.covariance.inverse();
  gaussian->vector = Eigen::Vector3d::Zero();
  gaussian->mean = state.start.mean.vector();
  return {{state.world, state.variable_of_clone[0]}, std::move(gaussian), nullptr};
}

/// The phase whose leaf shares the most states with a new one; the latest on a tie.
int closest_phase(const State& state, const std::vector<int>& variables) {
  std::vector<std::pair<int, int>> shared;  // phase, states
  for (const int v : variables) {
    for (const int phase : *state.phases_of[State::index(v)]) shared.emplace_back(phase, state.variable(v).dim);
  }
  std::sort(shared.begin(), shared.end());
  int best = -1;
  int most = 0;
  for (std::size_t i = 0; i < shared.size();) {
    const int phase = shared[i].first;
    int states = 0;
    for (; i < shared.size() && shared[i].first == phase; ++i) states += shared[i].second;
    if (states >= most) {
      most = states;
      best = phase;
    }
  }
  return best;
}

/// On new ground, where only the previous phase is shared, the tree grows like a binary counter: beside the lowest node above the
/// last leaf whose sibling is the larger. On old ground: beside the leaf.
int node_beside(const State& state, const std::vector<int>& variables, int phase) {
  const int last = static_cast<int>(state.phases.size()) - 1;
  int node = state.leaf_of_phase[State::index(phase)];
  if (phase != last) return node;
  const std::vector<int> before = variables_of(state.leaf(last));
  for (const int v : variables) {
    const auto& phases = *state.phases_of[State::index(v)];
    if (!phases.empty() && v != state.world && !std::binary_search(before.begin(), before.end(), v)) return node;
  }
  while (node != state.root) {
    const TreeNode& parent = state.node(state.node(node).parent);
    const int sibling = parent.child[0] == node ? parent.child[1] : parent.child[0];
    if (state.node(sibling).leaves > state.node(node).leaves) break;
    node = state.node(node).parent;
  }
  return node;
}

/// Hangs a leaf and a given node under a new one, in the node's place.
void hang_beside(State& state, int leaf, int beside) {
  const int parent = state.node(beside).parent;
  TreeNode joint;
  joint.parent = parent;
  joint.child = {beside, leaf};
  const int id = add_node(state, joint);
  state.nodes.write(State::index(beside)).parent = id;
  state.nodes.write(State::index(leaf)).parent = id;
  if (parent < 0) {
    state.root = id;
  } else {
    auto& child = state.nodes.write(State::index(parent)).child;
    (child[0] == beside ? child[0] : child[1]) = id;
  }
}

void insert(State& state, Leaf leaf) {
  const std::vector<int> variables = variables_of(leaf);
  const int phase = static_cast<int>(state.phases.size());
  const int closest = closest_phase(state, variables);
  const int beside = closest < 0 ? -1 : node_beside(state, variables, closest);
  std::vector<int> touched;
  for (const int v : variables) {
    if (state.variable(v).at >= 0) touched.push_back(state.variable(v).at);
    state.variables.write(State::index(v)).leaves += 1;
    auto phases = std::make_shared<std::vector<int>>(*state.phases_of[State::index(v)]);
    phases->push_back(phase);
    state.phases_of.write(State::index(v)) = std::move(phases);
  }
  state.phases.push_back(std::make_shared<const Leaf>(std::move(leaf)));
  TreeNode node;
  node.phase = phase;
  const int id = add_node(state, node);
  state.leaf_of_phase.push_back(id);
  if (beside < 0) {
    state.root = id;
  } else {
    hang_beside(state, id, beside);
    touched.push_back(beside);
  }
  touched.push_back(id);
  shape_paths(state, touched);
  rebalance(state, id);
}

/// Values on the paths of variables and of the last leaf, before these change.
void bring_along(State& state, const std::vector<int>& ids) {
  Estimates estimates(state);
  for (const core::LandmarkId id : ids) {
    const int v = variable_of(state, id);
    if (v >= 0) estimates.reach(state.variable(v).at);
    for (const int phase : v < 0 ? std::vector<int>() : *state.phases_of[State::index(v)]) {
      estimates.reach(state.leaf_of_phase[State::index(phase)]);
    }
  }
  if (!state.leaf_of_phase.empty()) estimates.reach(state.leaf_of_phase.back());
  estimates.store(state);
}

}  // namespace

int Atlas::add(PhaseFactor factor, std::shared_ptr<const PhaseLog> log) {
  check_factor(factor);
  check_determined(*working_, factor);
  finish_descent(*working_);
  State& state = *working_;
  const bool is_first = state.phases.empty();
  bring_along(state, factor.shape.ids);
  Leaf leaf;
  std::vector<int> variables = variables_for(state, factor);
  leaf.phase = std::make_shared<const PhaseFactor>(std::move(factor));
  leaf.parts.push_back({std::move(variables), gaussian_of(leaf.phase), nullptr});
  if (is_first && state.world != state.variable_of_clone[0]) leaf.parts.push_back(start_part(state));
  leaf.log = std::move(log);
  insert(state, std::move(leaf));
  return static_cast<int>(state.phases.size()) - 1;
}

}  // namespace helixnav::atlas
