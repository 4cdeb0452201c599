// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/mrpt_adapter/map_builder_options.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::config::CConfigFileMemory;

MapBuilderOptions loaded(const std::string& lines) {
  MapBuilderOptions options;
  options.loadFromConfigFile(CConfigFileMemory(std::string("[RangeBearingKFSLAM]\n" + lines)), "RangeBearingKFSLAM");
  return options;
}

std::string refusal(const std::string& lines) {
  try {
    loaded(lines);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, KeysOfKfSlamAreReadAsTheyAre) {
  const MapBuilderOptions options = loaded(R"(
stdXY_no_odo=0.1
stdPhi_no_odo_deg=2   // degs
std_odo_z_additional=0  // Additional uncertainty in z
force_ignore_odometry	= false
std_sensor_range     = 0.03  // meters
std_sensor_yaw_deg   = 0.1 // degrees
std_sensor_pitch_deg = 0.1  // degrees
quantiles_3D_representation=3
data_assoc_method=assocNN
data_assoc_IC_chi2_thres = 0.99
)");
  EXPECT_DOUBLE_EQ(options.stdPhi_no_odo_rad, 2.0 * core::pi / 180.0);
  EXPECT_DOUBLE_EQ(options.std_sensor_range, 0.03);
  EXPECT_DOUBLE_EQ(options.std_sensor_yaw_rad, 0.1 * core::pi / 180.0);
  EXPECT_FALSE(options.force_ignore_odometry);
  EXPECT_EQ(options.data_assoc_IC_chi2_thres, 0.99);
  EXPECT_EQ(options.association, "likelihood-ratio");
}

TEST(Options, JointTestOfKfSlamIsOursUnlessAMethodIsNamed) {
  EXPECT_EQ(loaded("data_assoc_method = assocJCBB\n").association, "jcbb");
  EXPECT_EQ(loaded("data_assoc_method = 1\n").association, "jcbb");
  EXPECT_EQ(loaded("data_assoc_method = 1\nassociation = nearest-neighbour\n").association, "nearest-neighbour");
}

TEST(Options, WhatIsSavedIsLoadedAgainToTheLastBit) {
  MapBuilderOptions options;
  options.stdPhi_no_odo_rad = 0.1;
  options.std_sensor_yaw_rad = 0.3;
  options.association = "jcbb";
  options.detector = "reflectors";
  options.retraction = "standard";
  options.gps_use = true;
  options.search_seed = 18'446'744'073'709'551'615u;
  options.search_threads = 3;
  options.cell_side = 1.0 / 3.0 + 7.0;
  CConfigFileMemory file;
  options.saveToConfigFile(file, "s");
  MapBuilderOptions back;
  back.loadFromConfigFile(file, "s");
  EXPECT_EQ(back.cell_side, options.cell_side);
  EXPECT_NEAR(back.stdPhi_no_odo_rad, 0.1, 1e-16);  // degrees in between
  EXPECT_EQ(back.search_seed, options.search_seed);
  EXPECT_EQ(back.search_threads, 3u);
  EXPECT_EQ(back.association, "jcbb");
  EXPECT_EQ(back.detector, "reflectors");
  EXPECT_EQ(back.retraction, "standard");
  EXPECT_TRUE(back.gps_use);
  CConfigFileMemory again;
  back.saveToConfigFile(again, "s");
  MapBuilderOptions third;
  third.loadFromConfigFile(again, "s");
  EXPECT_EQ(third.std_sensor_yaw_rad, back.std_sensor_yaw_rad);
}

TEST(Options, DumpNamesEveryKeyInTheUnitOfTheFile) {
  MapBuilderOptions options;
  std::ostringstream text;
  options.dumpToTextStream(text);
  for (const char* key :
       {"stdPhi_no_odo_deg", "std_sensor_yaw_deg", "odo_min_std_phi_deg", "association", "detector", "create_simplemap",
        "search_seed", "search_scale", "retraction", "gps_latitude_deg", "enable_profiler"}) {
    EXPECT_NE(text.str().find(key), std::string::npos) << key;
  }
}

TEST(Options, RefusalsNameSectionKeyValueAndRange) {
  EXPECT_EQ(refusal("std_sensor_range = -1\n"),
            "[RangeBearingKFSLAM] std_sensor_range = \"-1\": expected a number from 0 to 1e+06");
  EXPECT_NE(refusal("cell_side = wide\n").find("cell_side = \"wide\""), std::string::npos);
  EXPECT_NE(refusal("cell_side = nan\n").find("expected a number"), std::string::npos);
  EXPECT_NE(refusal("search_enabled = maybe\n").find("true or false"), std::string::npos);
  EXPECT_NE(refusal("association = jcb\n").find("nearest: jcbb"), std::string::npos);
  EXPECT_NE(refusal("retraction = right_invariant\n").find("nearest: right-invariant"), std::string::npos);
  EXPECT_NE(refusal("search_threads = 0\n").find("from 1 to 256"), std::string::npos);
  EXPECT_NE(refusal("search_seed = -1\n").find("whole number"), std::string::npos);
  EXPECT_NE(refusal("data_assoc_method = best\n").find("assocJCBB"), std::string::npos);
}

TEST(Options, RefusalLeavesThemAsTheyWere) {
  MapBuilderOptions options;
  const CConfigFileMemory file(std::string("[s]\nstdXY_no_odo = 0.5\ncell_side = -1\n"));
  EXPECT_THROW(options.loadFromConfigFile(file, "s"), core::InputError);
  EXPECT_EQ(options.stdXY_no_odo, MapBuilderOptions{}.stdXY_no_odo);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
