// SPDX-License-Identifier: BSD-3-Clause
#include "change/take_in.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "helixnav/core/angle.hpp"
#include "phase/world_form.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Values values_of(const State& state, const std::vector<int>& variables) {
  Values values;
  for (const int v : variables) values.push_back(state.value(v));
  return values;
}

/// The Gaussian of a phase, linearised where it is now if it can be.
RelativeGaussian derived_here(const Leaf& leaf, const Values& values) {
  if (leaf.log == nullptr) return leaf.phase->gaussian;
  const Eigen::VectorXd u = relative_coordinates(values);
  std::vector<Eigen::Vector2d> points_m;
  for (Index row = 3; row < u.size(); row += 2) points_m.emplace_back(u.segment<2>(row));
  return rederive_factor(*leaf.log, *leaf.phase, core::Pose2(Eigen::Vector3d(u.head<3>())), points_m).gaussian;
}

/// Rows of a phase's world form in the order: poses and landmarks that go, landmarks that stay, right-hand side.
struct RowOrder {
  std::vector<Index> to;
  Index gone = 0;
  Index all = 0;
};

RowOrder order_of(const std::vector<int>& variables, const std::vector<int>& stay) {
  std::vector<int> go(variables.begin() + 2, variables.end());
  std::sort(go.begin(), go.end());
  go.erase(std::unique(go.begin(), go.end()), go.end());
  const auto stays = [&](int v) { return std::binary_search(stay.begin(), stay.end(), v); };
  go.erase(std::remove_if(go.begin(), go.end(), stays), go.end());
  RowOrder order;
  order.gone = 6 + 2 * static_cast<Index>(go.size());
  order.all = order.gone + 2 * static_cast<Index>(stay.size());
  for (Index i = 0; i < 6; ++i) order.to.push_back(i);
  for (std::size_t i = 2; i < variables.size(); ++i) {
    const std::vector<int>& of = stays(variables[i]) ? stay : go;
    const auto at = std::lower_bound(of.begin(), of.end(), variables[i]) - of.begin();
    const Index row = (stays(variables[i]) ? order.gone : 6) + 2 * at;
    order.to.push_back(row);
    order.to.push_back(row + 1);
  }
  order.to.push_back(order.all);
  return order;
}

/// Information on the landmarks that stay, with right-hand side and χ² as last row: the Schur complement.
std::optional<MatrixXd> marginal(const MatrixXd& world, const RowOrder& order) {
  const MatrixXd A = world.selfadjointView<Eigen::Lower>();
  MatrixXd H = MatrixXd::Zero(order.all + 1, order.all + 1);
  for (std::size_t j = 0; j < order.to.size(); ++j) {
    for (std::size_t i = 0; i < order.to.size(); ++i) {
      H(order.to[i], order.to[j]) += A(static_cast<Index>(i), static_cast<Index>(j));
    }
  }
  const Eigen::VectorXd scale = H.diagonal().head(order.gone).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const MatrixXd gone = scale.asDiagonal() * H.topLeftCorner(order.gone, order.gone) * scale.asDiagonal();
  const Eigen::LLT<MatrixXd> llt(gone);
  if (llt.info() != Eigen::Success || llt.matrixLLT().diagonal().minCoeff() < 1e-6) return std::nullopt;
  const Index rest = order.all + 1 - order.gone;
  MatrixXd below = scale.asDiagonal() * H.topRightCorner(order.gone, rest);
  llt.matrixL().solveInPlace(below);
  return H.bottomRightCorner(rest, rest) - below.transpose() * below;
}

/// A part without information yet, about a new frame where the host begins. Its pose, which a part must have, stays without
/// information; the frame is held to the landmarks by a weight on its three motions, which it is free to meet.
Part begun_part(State& state, int host, double weight) {
  const Leaf& leaf = state.leaf(host);
  const std::vector<int> points = landmarks_of(leaf);
  Part part;
  part.variables = {-1, leaf.parts.front().variables[0]};
  part.variables.insert(part.variables.end(), points.begin(), points.end());
  part.variables[0] = add_variable(state, 3, -1, state.value(part.variables[1]));
  state.variables.write(State::index(part.variables[0])).leaves = 1;
  state.phases_of.write(State::index(part.variables[0])) =
      std::make_shared<const std::vector<int>>(std::vector<int>{host});
  auto gaussian = std::make_shared<RelativeGaussian>();
  gaussian->mean = relative_coordinates(values_of(state, part.variables));
  const Index n = gaussian->mean.size();
  MatrixXd motions = MatrixXd::Zero(n, 3);
  for (Index row = 3; row < n; row += 2) {
    motions.middleRows<2>(row) << 1.0, 0.0, -gaussian->mean[row + 1], 0.0, 1.0, gaussian->mean[row];
  }
  const MatrixXd Q = motions.householderQr().householderQ() * MatrixXd::Identity(n, 3);
  gaussian->information = weight * Q * Q.transpose();
  gaussian->vector = Eigen::VectorXd::Zero(n);
  part.gaussian = std::move(gaussian);
  return part;
}

/// The same Gaussian about another place.
void move_to(RelativeGaussian& g, const Eigen::VectorXd& mean) {
  Eigen::VectorXd delta = mean - g.mean;
  delta[2] = core::wrap_to_pi(delta[2]);
  const Eigen::VectorXd pull = g.information.full() * delta;
  g.chi2 += delta.dot(pull) - 2.0 * g.vector.dot(delta);
  g.vector -= pull;
  g.mean = mean;
}

/// Adds information on landmarks to a part, at the present values.
void add_said(const State& state, const MatrixXd& said, const std::vector<int>& stay, Part& part) {
  auto sum = std::make_shared<RelativeGaussian>(*part.gaussian);
  move_to(*sum, relative_coordinates(values_of(state, part.variables)));
  std::vector<Index> rows;
  for (const int v : stay) {
    const Index at = std::find(part.variables.begin() + 2, part.variables.end(), v) - part.variables.begin();
    rows.push_back(2 * at - 1);
    rows.push_back(2 * at);
  }
  const Index n = static_cast<Index>(rows.size());
  MatrixXd information = sum->information.full();
  information(rows, rows) += 0.5 * (said.topLeftCorner(n, n) + said.topLeftCorner(n, n).transpose());
  sum->information = information;
  sum->vector(rows) += said.bottomRows<1>().head(n).transpose();
  sum->chi2 += said(n, n);
  part.gaussian = std::move(sum);
}

}  // namespace

bool take_in(State& state, int host, int phase) {
  const Leaf& leaf = state.leaf(phase);
  const std::vector<int>& variables = leaf.parts.front().variables;
  const std::vector<int> points = landmarks_of(leaf);
  const std::vector<int> of_host = landmarks_of(state.leaf(host));
  std::vector<int> stay;
  std::set_intersection(points.begin(), points.end(), of_host.begin(), of_host.end(), std::back_inserter(stay));
  Leaf changed = state.leaf(host);
  const bool is_first = changed.revisits < 0;
  const int frame =
      is_first ? changed.parts.front().variables[0] : changed.parts[State::index(changed.revisits)].variables[0];
  const core::Pose2 T_frame_atlas = core::inverse(core::Pose2(Eigen::Vector3d(state.value(frame))));
  Values seen;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const Eigen::Vector3d& value = state.value(variables[i]);
    Eigen::Vector3d here = Eigen::Vector3d::Zero();
    here.head<2>() = core::transform(T_frame_atlas, value.head<2>());
    if (i < 2) here = core::compose(T_frame_atlas, core::Pose2(value)).vector();
    seen.push_back(here);
  }
  const std::optional<MatrixXd> said = marginal(world_form(derived_here(leaf, seen), seen), order_of(variables, stay));
  if (!said) return false;
  if (is_first) {
    const Index n = said->rows() - 1;
    const double weight = said->diagonal().head(n).sum() / static_cast<double>(n);
    changed.revisits = static_cast<int>(changed.parts.size());
    changed.parts.push_back(begun_part(state, host, weight));
  }
  add_said(state, *said, stay, changed.parts[State::index(changed.revisits)]);
  state.phases.write(State::index(host)) = std::make_shared<const Leaf>(std::move(changed));
  return true;
}

}  // namespace helixnav::atlas
