// SPDX-License-Identifier: BSD-3-Clause
//
// Continuing in the map of an earlier run, inside MRPT: the first drive saves its map, the second begins somewhere on
// it without being told where, and is told once that it was carried.
#include <iostream>

#include <helixnav/mrpt_adapter/map_builder.hpp>

#include "robot.hpp"

namespace {

using helixnav::mrpt_adapter::MapBuilder;

void drive(MapBuilder& builder, Robot& robot, int frames) {
  for (int k = 0; k < frames; ++k) {
    mrpt::obs::CActionCollection action = robot.moved();
    mrpt::obs::CSensoryFrame frame = robot.seen();
    builder.processActionObservation(action, frame);
  }
}

void say(const char* what, const MapBuilder& builder, const Robot& robot) {
  const auto error_m = builder.getCurrentPoseEstimation()->getMeanVal().distanceTo(mrpt::poses::CPose3D(robot.pose()));
  std::cout << what << ": place " << (builder.isPlaceKnown() ? "known" : "sought") << ", "
            << (error_m < 0.5 ? "right" : "elsewhere") << '\n';
}

}  // namespace

int main() {
  helixnav::mrpt_adapter::MapBuilderOptions options;
  options.std_sensor_range = 0.05;
  options.std_sensor_yaw_rad = 0.005;

  Robot monday(0.0);
  MapBuilder first(options);
  drive(first, monday, 110);
  first.saveMapToFolder("monday");  // map.bin and map.csv; a run folder of helixnav or helixnav-slam works as well

  Robot tuesday(35.0);  // begins 35 m along the way, without being told
  MapBuilder second(options);
  second.loadCurrentMapFromFile("monday");
  drive(second, tuesday, 1);
  say("at the begin", second, tuesday);
  drive(second, tuesday, 60);
  say("after a while", second, tuesday);

  tuesday.carry(20.0);
  second.relocalize();
  drive(second, tuesday, 1);
  say("carried", second, tuesday);
  drive(second, tuesday, 60);
  say("found again", second, tuesday);

  tuesday.carry(50.0);
  second.setInitialPose(mrpt::poses::CPosePDFGaussian(tuesday.pose(), Robot::start_covariance()));
  drive(second, tuesday, 1);
  say("given a pose", second, tuesday);
}
