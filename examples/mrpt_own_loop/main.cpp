// SPDX-License-Identifier: BSD-3-Clause
//
// HelixNav in a loop of your own, in place of CRangeBearingKFSLAM2D.
#include <iostream>

#include <mrpt/maps/CLandmarksMap.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include <helixnav/mrpt_adapter/map_builder.hpp>

#include "robot.hpp"

int main() {
  helixnav::mrpt_adapter::MapBuilderOptions options;
  options.std_sensor_range = 0.1;
  options.std_sensor_yaw_rad = 0.01;
  helixnav::mrpt_adapter::MapBuilder builder(options);
  for (Robot robot; robot.drives();) {
    mrpt::obs::CActionCollection action = robot.moved();
    mrpt::obs::CSensoryFrame frame = robot.seen();
    builder.processActionObservation(action, frame);
  }
  const auto pose = builder.getCurrentPoseEstimation()->getMeanVal();
  const mrpt::maps::CMultiMetricMap& map = *builder.getCurrentlyBuiltMetricMap();
  std::cout << map.mapByClass<mrpt::maps::CLandmarksMap>()->landmarks.size() << " landmarks, robot at " << pose << '\n';
  builder.saveCurrentEstimationToImage("map.png");
}
