// SPDX-License-Identifier: BSD-3-Clause
// Logs of several files, ACFR text and Plaza: a text with a line "=== name" before each. In LASER.txt a # stands for the
// 361 readings of a scan.
#include "fuzz_input.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/logs/sick_scan.hpp"

namespace {

std::string with_readings(const std::string& text) {
  std::string expanded;
  for (const char c : text) {
    if (c != '#') {
      expanded += c;
      continue;
    }
    for (int beam = 0; beam < helixnav::logs::SickScan::beams; ++beam) expanded += beam % 60 < 4 ? "\t8.1" : "\t81.9";
  }
  return expanded;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  fuzz::folder();
  const helixnav::testing::TemporaryFolder log;
  fuzz::write_files(data, size, log, [](const std::string& name, const std::string& text) {
    return name == "LASER.txt" ? with_readings(text) : text;
  });
  fuzz::read_or_refuse([&] { fuzz::check_recording(logs::read_recording(log.path())); });
  return 0;
}
