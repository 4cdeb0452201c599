// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include <mrpt/obs/CObservation.h>
#include <Eigen/Core>

#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "slam/slam_config.hpp"

namespace helixnav::apps {

/// The files that users of kf-slam expect, in the run folder: data_association.log during the run; if SAVE_LOG_FREQUENCY
/// is set, robot_pose_N.txt, full_cov_N.txt and kf_state_N.3Dscene; at the end robot_pose.txt, full_cov.txt,
/// landmarks.txt, kf_state.3Dscene, map.simplemap and map.png. InputError if one cannot be written. Files of these names
/// left in the folder by an earlier run are removed at the beginning, and no others.
/// Test: mrpt_apps/slam_test.cpp.
class SlamFiles {
 public:
  SlamFiles(const SlamConfig& config, std::string folder, std::vector<Eigen::Vector2d> true_path_m);

  void write_step(const mrpt_adapter::MapBuilder& builder, const mrpt::obs::CObservation& seen, std::size_t step);
  void write_end(mrpt_adapter::MapBuilder& builder);

 private:
  void write_associations(const mrpt_adapter::MapBuilder& builder, const mrpt::obs::CObservation& seen);
  void write_state(const mrpt_adapter::MapBuilder& builder, const std::string& suffix) const;
  void write_picture(mrpt_adapter::MapBuilder& builder) const;

  const SlamConfig& config_;
  std::string folder_;
  std::vector<Eigen::Vector2d> true_path_m_;
  std::ofstream associations_;
};

}  // namespace helixnav::apps
