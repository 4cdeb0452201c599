// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_input.hpp"
#include "helixnav/logs/graph_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  const fuzz::MemoryFile file(data, size);
  fuzz::read_or_refuse(
      [&] { fuzz::check_recording(logs::recording_from_graph(logs::read_g2o(file.path()), "input")); });
  return 0;
}
