// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_input.hpp"
#include "helixnav/logs/dlr.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helixnav;
  const fuzz::MemoryFile file(data, size);
  fuzz::read_or_refuse([&] { fuzz::check_recording(logs::read_dlr(file.path())); });
  return 0;
}
