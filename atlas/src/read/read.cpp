// SPDX-License-Identifier: BSD-3-Clause
#include "read/read.hpp"

#include <algorithm>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::atlas {
namespace {

int find_named(const State& state, core::LandmarkId id) {
  if (id < 0 || id >= static_cast<int>(state.variable_of_landmark.size())) return -1;
  const int v = state.variable_of_landmark[State::index(id)];
  return v >= 0 && state.variable(v).name >= 0 ? v : -1;
}

core::Pose2 pose_of(const Eigen::Vector3d& value) { return core::Pose2(value); }

/// A clone in the atlas' own frame. One between two condensed phases is where the second began, as seen from its host.
core::Pose2 T_atlas_clone(const State& state, Estimates& estimates, int k) {
  const int v = state.variable_of_clone[State::index(k)];
  if (state.variable(v).at >= 0 || k == static_cast<int>(state.phases.size())) return pose_of(estimates.of(v));
  const Leaf& leaf = state.leaf(k);
  if (leaf.host < 0) return pose_of(estimates.of(v));
  return core::compose(T_atlas_clone(state, estimates, leaf.host), leaf.T_host_entry);
}

}  // namespace

core::Pose2 T_map_atlas(const State& state, Estimates& estimates) {
  const core::Pose2 T_world_atlas = core::inverse(pose_of(estimates.of(state.world)));
  const bool is_first_clone = state.world == state.variable_of_clone[0];
  return is_first_clone ? core::compose(state.start.mean, T_world_atlas) : T_world_atlas;
}

int variable_of_named(const State& state, core::LandmarkId id) {
  const int v = find_named(state, id);
  if (v < 0) throw core::PreconditionError("atlas: no landmark " + std::to_string(id));
  return v;
}

int Atlas::phase_count() const { return static_cast<int>(settled_->phases.size()); }

bool Atlas::knows(core::LandmarkId id) const { return find_named(*settled_, id) >= 0; }

core::Pose2 Atlas::pose() const { return clone(phase_count()); }

core::Pose2 Atlas::clone(int k) const {
  const State& state = *settled_;
  if (k < 0 || k >= static_cast<int>(state.variable_of_clone.size())) {
    throw core::PreconditionError("atlas: no clone " + std::to_string(k));
  }
  Estimates estimates(state);
  const core::Pose2 T_map = T_map_atlas(state, estimates);
  return core::compose(T_map, T_atlas_clone(state, estimates, k));
}

Eigen::Vector2d Atlas::landmark(core::LandmarkId id) const { return places_of({id}).front().point_m; }

std::vector<Place> Atlas::places_of(const std::vector<core::LandmarkId>& ids) const {
  Estimates estimates(*settled_);
  const core::Pose2 T_map = T_map_atlas(*settled_, estimates);
  std::vector<Place> places;
  places.reserve(ids.size());
  for (const core::LandmarkId id : ids) {
    places.push_back({id, core::transform(T_map, estimates.of(variable_of_named(*settled_, id)).head<2>())});
  }
  return places;
}

double Atlas::chi2() const { return settled_->root < 0 ? 0.0 : settled_->node(settled_->root).front->message.back(); }

std::vector<Place> Atlas::landmarks() const {
  const State& state = *settled_;
  std::vector<Place> places;
  if (state.root < 0) return places;
  Estimates estimates(state);
  estimates.update_all(state.root);
  const core::Pose2 T_map = T_map_atlas(state, estimates);
  for (std::size_t id = 0; id < state.variable_of_landmark.size(); ++id) {
    const int v = find_named(state, static_cast<core::LandmarkId>(id));
    if (v < 0 || state.variable(v).name != static_cast<int>(id)) continue;
    places.push_back({static_cast<core::LandmarkId>(id), core::transform(T_map, estimates(v).head<2>())});
  }
  return places;
}

std::vector<core::Pose2> Atlas::clones() const {
  const State& state = *settled_;
  Estimates estimates(state);
  if (state.root >= 0) estimates.update_all(state.root);
  const core::Pose2 T_map = T_map_atlas(state, estimates);
  std::vector<core::Pose2> poses;
  for (std::size_t k = 0; k < state.variable_of_clone.size(); ++k) {
    poses.push_back(core::compose(T_map, T_atlas_clone(state, estimates, static_cast<int>(k))));
  }
  return poses;
}

namespace {

/// The poses of a phase where it was linearised last, at its entry.
std::vector<core::Pose2> poses_along(const Leaf& leaf, const core::Pose2& T_map_entry) {
  std::vector<core::Pose2> poses;
  for (const core::Pose2& T_entry_robot : leaf.phase->shape.T_entry_robot) {
    poses.push_back(core::compose(T_map_entry, T_entry_robot));
  }
  return poses;
}

/// Since then the exit may have moved by as much as makes a phase be derived again:
/// the poses follow it, each by its share of the steps.
void follow_exit(const core::Pose2& T_map_exit, std::vector<core::Pose2>& poses) {
  if (poses.empty()) return;
  const Eigen::Vector2d moved_m = T_map_exit.position_m() - poses.back().position_m();
  const double turned_rad = core::wrap_to_pi(T_map_exit.heading_rad - poses.back().heading_rad);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(poses.size());
    const Eigen::Vector2d at_m = poses[i].position_m() + share * moved_m;
    poses[i] = core::Pose2(at_m.x(), at_m.y(), core::wrap_to_pi(poses[i].heading_rad + share * turned_rad));
  }
}

/// `clone(k)`: where clone k is. A condensed one stays where it is in its host.
template <class Clone>
std::vector<core::Pose2> poses_between(const Leaf& leaf, int phase, const Clone& clone) {
  if (leaf.host >= 0) return poses_along(leaf, core::compose(clone(leaf.host), leaf.T_host_entry));
  std::vector<core::Pose2> poses = poses_along(leaf, clone(phase));
  follow_exit(clone(phase + 1), poses);
  return poses;
}

}  // namespace

std::vector<core::Pose2> Atlas::poses_of(int phase) const {
  if (phase < 0 || phase >= phase_count()) {
    throw core::PreconditionError("atlas: no phase " + std::to_string(phase));
  }
  return poses_between(settled_->leaf(phase), phase, [this](int k) { return clone(k); });
}

std::vector<std::vector<core::Pose2>> Atlas::poses() const {
  const std::vector<core::Pose2> entries = clones();
  std::vector<std::vector<core::Pose2>> poses;
  for (int phase = 0; phase < phase_count(); ++phase) {
    poses.push_back(poses_between(settled_->leaf(phase), phase, [&](int k) { return entries[State::index(k)]; }));
  }
  return poses;
}

namespace {

void measure(const State& state, int id, int depth, Atlas::Size& size) {
  const TreeNode& node = state.node(id);
  const double ne = node.shape->ne;
  const double nb = node.shape->nb;
  size.depth = std::max(size.depth, depth);
  size.largest_front = std::max(size.largest_front, node.shape->ne + node.shape->nb);
  size.factor_nonzeros += 0.5 * ne * (ne + 1.0) + ne * nb;
  size.message_nonzeros += 0.5 * nb * (nb + 1.0);
  if (node.phase >= 0) return;
  for (const int child : node.child) measure(state, child, depth + 1, size);
}

}  // namespace

Atlas::Size Atlas::size() const {
  Size size;
  size.phases = phase_count();
  if (settled_->root < 0) return size;
  for (std::size_t k = 0; k < settled_->phases.size(); ++k) size.condensed += settled_->phases[k]->host >= 0 ? 1 : 0;
  size.root_front = settled_->node(settled_->root).shape->ne;
  measure(*settled_, settled_->root, 0, size);
  return size;
}

int Atlas::nodes_redone() const { return nodes_redone_; }

}  // namespace helixnav::atlas
