// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/atlas/phase_factor.hpp"
#include "helixnav/atlas/relative_gaussian.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/se2.hpp"
#include "tree/persistent_vector.hpp"

namespace helixnav::atlas {

/// Values of variables in the atlas' own frame: poses (x, y, heading), points (x, y, 0). That frame is arbitrary: the map
/// frame is given by variable `State::world`.
using Values = std::vector<Eigen::Vector3d>;

struct Variable {
  int dim = 0;     ///< 3: pose, 2: point
  int name = -1;   ///< of a landmark or a clone; −1: none, or forgotten
  int leaves = 0;  ///< number of leaves that hold it
  int at = -1;     ///< node that eliminates it
};

/// A factor with its variables: the reference pose, the pose, the points.
struct Part {
  std::vector<int> variables;
  std::shared_ptr<const RelativeGaussian> gaussian;
  std::shared_ptr<const core::AbsoluteFix> fix;  ///< what it came from, unless from the log
  double weight = 1.0;                           ///< other than 1 only while settling is damped
};

struct Leaf {
  std::shared_ptr<const PhaseLog> log;       ///< null: cannot be linearised again
  std::shared_ptr<const PhaseFactor> phase;  ///< the first part
  std::vector<Part> parts;
  int revisits = -1;  ///< the part that holds what other phases have seen here (condense), about a frame of its own
  int host = -1;      ///< for a condensed phase: the phase that holds what it has seen, …
  core::Pose2 T_host_entry;  ///< … and where it began, relative to where the host begins
};

/// The Gaussian of a phase, which lives as long as either.
inline std::shared_ptr<const RelativeGaussian> gaussian_of(const std::shared_ptr<const PhaseFactor>& phase) {
  return {phase, &phase->gaussian};
}

/// Which variables a node eliminates and which it passes on, without numbers.
struct FrontShape {
  std::vector<int> variables;                  ///< eliminated ones, then the boundary, each increasing
  std::vector<int> offsets;                    ///< first row of each
  std::vector<int> counts;                     ///< number of leaves of the subtree that hold each
  int eliminated = 0;                          ///< how many of `variables`
  int ne = 0;                                  ///< rows eliminated
  int nb = 0;                                  ///< rows of the boundary
  std::array<std::vector<int>, 2> from_child;  ///< offset here of each boundary variable of either child

  int boundary() const { return static_cast<int>(variables.size()) - eliminated; }
};

/// A disk that contains the landmarks eliminated in a subtree.
struct Disk {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double radius_m = -1.0;  ///< negative: empty
};

/// A node's factor and its message, about `linearised_at`.
struct Front {
  Eigen::MatrixXd L;            ///< (ne+nb+1)×ne; the last row belongs to the right-hand side
  std::vector<double> message;  ///< lower triangle of (nb+1)×(nb+1), column by column; last row η, last corner χ²
  Values linearised_at;         ///< in the order of FrontShape::variables
  std::array<double, 2> child_turn_rad{0.0, 0.0};  ///< by which the children's messages were turned
  Disk landmarks;                                  ///< where `linearised_at` puts them
};

struct TreeNode {
  int parent = -1;
  std::array<int, 2> child{-1, -1};
  int phase = -1;  ///< of a leaf
  int leaves = 1;
  bool dirty = true;   ///< front out of date, as are those above; the values of its variables are not
  bool fresh = false;  ///< front new, estimates not yet drawn from it
  std::shared_ptr<const FrontShape> shape;
  std::shared_ptr<const Front> front;
  std::shared_ptr<const Values> opened_at;  ///< boundary when its estimates were last written
};

/// The map as a value: a copy shares everything and costs O(1).
struct State {
  Options options;
  core::PoseGaussian start;
  PersistentVector<Variable> variables;
  PersistentVector<Eigen::Vector3d> values;
  PersistentVector<std::shared_ptr<const std::vector<int>>> phases_of;  ///< variable → phases that hold it
  PersistentVector<int> variable_of_landmark;                           ///< −1: unknown
  PersistentVector<int> variable_of_clone;
  PersistentVector<std::shared_ptr<const Leaf>> phases;
  PersistentVector<int> leaf_of_phase;
  PersistentVector<TreeNode> nodes;
  int free_node = -1;  ///< head of a list of nodes no longer in any tree, linked by their parents
  int condensed = 0;   ///< phases up to here have been looked at by condense
  int root = -1;
  int world = -1;  ///< variable that represents the map frame

  bool descending = false;   ///< settle is on its way down
  std::vector<int> to_open;  ///< a stack
  int rounds = 0;
  std::shared_ptr<const State>
      begun;  ///< where settling began, if it was stopped and not resumed, and nothing has changed since

  bool is_leaf(int node) const { return nodes[index(node)].phase >= 0; }
  bool is_clean() const { return root < 0 || (!descending && !nodes[index(root)].dirty); }

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  const Variable& variable(int v) const { return variables[index(v)]; }
  const Eigen::Vector3d& value(int v) const { return values[index(v)]; }
  const TreeNode& node(int i) const { return nodes[index(i)]; }
  const Leaf& leaf(int phase) const { return *phases[index(phase)]; }
};

/// Variables of a leaf, increasing, each once.
std::vector<int> variables_of(const Leaf& leaf);

/// Landmarks of a phase, as it was driven: variables, increasing, each once.
std::vector<int> landmarks_of(const Leaf& leaf);

/// A variable that no phase holds yet.
int add_variable(State& state, int dim, int name, const Eigen::Vector3d& value);

/// A node not yet in any tree.
int add_node(State& state, const TreeNode& node);

/// Marks a node and all above it.
void mark_dirty(State& state, int node);

/// Current values of a front's variables [begin, end).
Values values_of(const State& state, const FrontShape& shape, int begin, int end);

}  // namespace helixnav::atlas
