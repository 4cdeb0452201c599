// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "helixnav/core/errors.hpp"
#include "phase/rigid_fit.hpp"
#include "read/read.hpp"

namespace helixnav::atlas {
namespace {

struct Search {
  const State& state;
  Estimates& estimates;
  Eigen::Vector2d center_m;  ///< in the atlas' own frame
  double radius_m;
  std::vector<int> found;

  /// What may have moved in a subtree beyond the rigid motion of its boundary.
  double slack_m(const Motion& motion, const Disk& disk) const {
    return 1.0 + motion.rest_m + 2.0 * std::sqrt(state.options.bend_m * (10.0 + 2.0 * disk.radius_m));
  }

  void visit(int id) {
    const TreeNode& node = state.node(id);
    const FrontShape& shape = *node.shape;
    const Disk& disk = node.front->landmarks;
    if (disk.radius_m < 0.0) return;
    const Motion motion = motion_of(state, shape, shape.eliminated, node.front->linearised_at.data() + shape.eliminated,
                                    estimates.of_boundary(id));
    const double apart_m = (motion.rigid.point(disk.center_m) - center_m).norm();
    if (apart_m > radius_m + disk.radius_m + slack_m(motion, disk)) return;
    estimates.update(id);
    for (int i = 0; i < shape.eliminated; ++i) {
      const int v = shape.variables[State::index(i)];
      if (state.variable(v).dim != 2 || state.variable(v).name < 0) continue;
      if ((estimates(v).head<2>() - center_m).norm() <= radius_m) found.push_back(v);
    }
    if (node.phase >= 0) return;
    for (const int child : node.child) visit(child);
  }
};

}  // namespace

std::vector<Place> Atlas::near(const Eigen::Vector2d& center_m, double radius_m) const {
  if (!center_m.allFinite() || !(radius_m >= 0.0)) throw core::PreconditionError("atlas: no such disk");
  const State& state = *settled_;
  std::vector<Place> places;
  if (state.root < 0) return places;
  Estimates estimates(state);
  const core::Pose2 T_map = T_map_atlas(state, estimates);
  Search search{state, estimates, core::transform(core::inverse(T_map), center_m), radius_m, {}};
  search.visit(state.root);
  for (const int v : search.found) {
    places.push_back({state.variable(v).name, core::transform(T_map, estimates(v).head<2>())});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.id < b.id; });
  return places;
}

}  // namespace helixnav::atlas
