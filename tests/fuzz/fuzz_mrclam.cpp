// SPDX-License-Identifier: BSD-3-Clause
// Tables of several robots: a text with a line "=== name" before each; MRCLAM's own names, or those of the tables.
#include "fuzz_input.hpp"
#include "helixnav/logs/mrclam.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  fuzz::folder();
  const helixnav::testing::TemporaryFolder log;
  fuzz::write_files(data, size, log, [](const std::string&, const std::string& text) { return text; });
  fuzz::read_or_refuse([&] {
    const core::TeamRecording team = logs::read_mrclam(log.path());
    for (const core::TeamMember& robot : team.robots) {
      fuzz::check_recording(robot.recording);
      for (const core::RobotSighting& sighting : robot.sightings) {
        fuzz::require(sighting.seen >= 0 && static_cast<std::size_t>(sighting.seen) < team.robots.size(),
                      "a robot seen that is not there");
      }
    }
  });
  return 0;
}
