// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"
#include "slam/slam_app.hpp"

int main(int argc, char** argv) {
  helixnav::apps::SlamApp app;
  return helixnav::apps::run_program(app.command_line(), [&] {
    app.initialize(argc, const_cast<const char**>(argv));
    return app.run();
  });
}
