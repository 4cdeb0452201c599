// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_input.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/acfr_recording.hpp"
#include "helixnav/logs/graph_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  const fuzz::MemoryFile file(data, size);
  fuzz::read_or_refuse([&] { fuzz::check_recording(logs::read_vicpark_clean(file.path())); });
  fuzz::read_or_refuse([&] {
    const logs::AcfrLog log = logs::read_car_park_mat(file.path());
    fuzz::check_recording(logs::make_recording(log, logs::car_park_settings()));
  });
  fuzz::read_or_refuse([&] { logs::read_victoria_park_gps(file.path()); });
  return 0;
}
