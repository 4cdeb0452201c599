// SPDX-License-Identifier: BSD-3-Clause
// A configuration file: what is accepted is the same when written and read again.
#include <CLI/CLI.hpp>

#include "fuzz_input.hpp"
#include "settings/config_file.hpp"
#include "settings/settings.hpp"

namespace {

using namespace helixnav;

std::string settings_of(const std::filesystem::path& file) {
  CLI::App app;
  apps::Settings settings;
  apps::add_settings(app, settings);
  apps::apply_config_file(app, file.string());
  return apps::dump_config(app);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse([&] {
    std::string dumped;
    try {
      dumped = settings_of(fuzz::MemoryFile(data, size).path());
    } catch (const CLI::ParseError&) {
      return;  // refused
    }
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(dumped.data());
    std::string again;
    try {
      again = settings_of(fuzz::MemoryFile(bytes, dumped.size()).path());
    } catch (const CLI::ParseError& error) {
      fuzz::fail("what was written is refused: " + std::string(error.what()));
    }
    fuzz::require(again == dumped, "what was written reads otherwise");
  });
  return 0;
}
