// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include <helixnav/core/se2.hpp>
#include <helixnav/core/version.hpp>

int main() {
  const helixnav::core::Pose2 T_world_robot(1.0, 2.0, 0.5);
  const helixnav::core::Pose2 back = compose(T_world_robot, inverse(T_world_robot));
  std::cout << "HelixNav " << helixnav::core::version() << " at " << back.vector().transpose() << '\n';
}
