// SPDX-License-Identifier: BSD-3-Clause
// A log of the user's own: a text with a line "=== name" before each of its files, read with its vehicle; missing files
// come from a good log. If there is a file log.jsonl, that is the log.
#include "fuzz_input.hpp"
#include "helixnav/logs/own_log.hpp"
#include "own/own_log_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  fuzz::folder();
  const logs::OwnLogFolder log;
  const auto changed = fuzz::files_of(data, size);
  for (const char* name : {"vehicle.toml", "odometry.csv", "detections.csv", "fixes.csv", "lost.csv", "truth_poses.csv",
                           "truth_landmarks.csv", "log.jsonl"}) {
    const auto file = changed.find(name);
    if (file != changed.end()) log.write(name, file->second);
  }
  const std::filesystem::path folder = log.folder.path();
  fuzz::read_or_refuse([&] {
    const bool is_lines = changed.count("log.jsonl") > 0;
    const logs::OwnLog own = logs::read_own_log(is_lines ? folder / "log.jsonl" : folder);
    const logs::Vehicle vehicle = logs::read_vehicle(folder / "vehicle.toml");
    fuzz::check_recording(logs::make_recording(own, vehicle));
  });
  return 0;
}
