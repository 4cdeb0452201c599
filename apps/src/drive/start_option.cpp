// SPDX-License-Identifier: BSD-3-Clause
#include "start_option.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace helixnav::apps {

CLI::Option* add_start_option(CLI::App& command, std::optional<SessionStart>& start) {
  const auto objection_to = [](const std::string& word) {
    std::string objection;
    session_start_from(word, objection);
    return objection;
  };
  const auto take = [&start](const std::string& word) {
    std::string none;
    start = session_start_from(word, none);
  };
  return command
      .add_option_function<std::string>(
          "--start", take,
          "Where on that map: unknown (the session maps on its own until its place is found; the default except with "
          "--localize, which starts where the log says), end (where that run ended), or a pose in metres and radians")
      ->type_name("unknown|end|x,y,heading")
      ->check(objection_to);
}

}  // namespace helixnav::apps
