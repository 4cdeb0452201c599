// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/LU>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::cekf {

/// Sums over one or many runs.
struct StudySums {
  double nees = 0.0;  ///< of the pose (3 degrees of freedom) after the scans of the last quarter
  int poses = 0;
  double nis = 0.0;  ///< of all joint updates
  int nis_dof = 0;
  int updates = 0;
  int updates_inside = 0;  ///< NIS inside the two-sided 95 % band of χ² with the update's degrees of freedom

  double mean_nees() const { return nees / poses; }
  double nis_per_dof() const { return nis / nis_dof; }
  double share_inside() const { return static_cast<double>(updates_inside) / updates; }
  void add(const StudySums& other) {
    nees += other.nees;
    poses += other.poses;
    nis += other.nis;
    nis_dof += other.nis_dof;
    updates += other.updates;
    updates_inside += other.updates_inside;
  }
};

/// The filter on a recording whose labels are the association: the first sight of a label becomes a landmark.
class KnownAssociation {
 public:
  KnownAssociation(const core::Recording& recording, const FilterOptions& options)
      : recording_(recording), filter_(recording.start, options) {}

  StudySums drive() {
    std::size_t scan = 0;
    for (const core::Event& event : recording_.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) filter_.predict(*odometry);
      if (const auto* seen = std::get_if<core::Scan>(&event)) take(*seen, scan++);
    }
    return sums_;
  }

 private:
  void take(const core::Scan& scan, std::size_t index) {
    std::vector<Match> matches;
    std::vector<std::pair<core::Label, const core::Observation*>> fresh;
    for (std::size_t i = 0; i < scan.observations.size(); ++i) {
      const core::Label label = recording_.labels[index][i];
      if (label == core::no_label) continue;
      const auto known = ids_.find(label);
      if (known == ids_.end()) {
        fresh.emplace_back(label, &scan.observations[i]);
      } else {
        matches.push_back({known->second, scan.observations[i], scan.T_robot_sensor});
      }
    }
    if (!matches.empty()) count(filter_.update(matches));
    for (const auto& [label, z] : fresh) ids_[label] = filter_.augment(*z, scan.T_robot_sensor);
    filter_.switch_region_if_due();
    if (4 * index >= 3 * recording_.true_poses.size()) compare(recording_.true_poses[index].T_world_robot);
  }

  void count(const UpdateResult& update) {
    sums_.nis += update.nis;
    sums_.nis_dof += update.dof;
    ++sums_.updates;
    const bool inside =
        update.nis >= core::chi2_quantile(0.025, update.dof) && update.nis <= core::chi2_quantile(0.975, update.dof);
    sums_.updates_inside += inside ? 1 : 0;
  }

  void compare(const core::Pose2& truth) {
    const core::PoseGaussian pose = filter_.pose();
    Eigen::Vector3d error = truth.vector() - pose.mean.vector();
    error[2] = core::wrap_to_pi(error[2]);
    sums_.nees += error.dot(pose.covariance.inverse() * error);
    ++sums_.poses;
  }

  const core::Recording& recording_;
  CompressedEkf filter_;
  std::map<core::Label, core::LandmarkId> ids_;
  StudySums sums_;
};

/// Runs a named scenario of sim with `runs` seeds from `first_seed`.
inline StudySums drive_scenario(std::string_view name, const FilterOptions& options, std::uint64_t first_seed,
                                int runs) {
  StudySums sums;
  const sim::Scenario scenario = sim::named_scenario(name);
  for (int run = 0; run < runs; ++run) {
    const core::Recording recording = sim::simulate(scenario, first_seed + static_cast<std::uint64_t>(run));
    sums.add(KnownAssociation(recording, options).drive());
  }
  return sums;
}

}  // namespace helixnav::cekf
