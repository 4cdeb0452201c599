// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/mrpt_adapter/map_builder_options.hpp"

namespace helixnav::apps {

/// The contents of a kf-slam configuration file and of the optional section [HelixNav].
struct SlamConfig {
  // [MappingApplication]
  std::string rawlog_file;
  std::size_t rawlog_offset = 0;
  std::string logOutput_dir = "OUT_HELIXNAV-SLAM";  ///< empty: no files
  std::size_t SAVE_LOG_FREQUENCY = 0;               ///< steps between two sets of files; 0: at the end only
  bool SAVE_DA_LOG = true;
  bool SAVE_3D_SCENES = true;
  bool SHOW_3D_LIVE = false;
  bool CAMERA_3DSCENE_FOLLOWS_ROBOT = false;
  std::string ground_truth_file;
  std::string ground_truth_file_robot;

  // [HelixNav], beside the keys of MapBuilderOptions, which [RangeBearingKFSLAM] may hold as well.
  bool save_png = true;
  bool overwrite = false;
  std::string map;  ///< run folder whose map is continued, from anywhere on it; empty: none
  mrpt_adapter::MapBuilderOptions builder;

  std::vector<std::string> without_effect;  ///< keys only for kf-slam itself, as [section] key
};

/// Reads `path`. InputError, naming file, section, key and value: no file, none of the sections, an invalid value for a key, an
/// unknown key in [HelixNav] (with the nearest), kf_implementation neither CRangeBearingKFSLAM nor CRangeBearingKFSLAM2D, a
/// `method` that is not a TKFMethod of MRPT. A file that names one of MRPT's two plain EKFs there gets the standard retraction,
/// unless it sets `retraction` itself. Test: mrpt_apps/slam_config_test.cpp.
SlamConfig read_slam_config(const std::string& path);

}  // namespace helixnav::apps
