// SPDX-License-Identifier: BSD-3-Clause
#include "usage_error.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <CLI/CLI.hpp>

#include "helixnav/core/nearest_name.hpp"

namespace helixnav::apps {
namespace {

/// The subcommand that was being parsed, else the program itself.
const CLI::App& parsed_app(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : *chosen.front();
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

/// So near that it may have been meant: two letters, or a third of a long name.
bool is_near(const std::string& name, const std::string& nearest) {
  return core::edit_distance(name, nearest) <= std::max<std::size_t>(2, name.size() / 3);
}

std::string unknown_word(const CLI::App& app, const std::string& word) {
  const bool is_option = word.rfind('-', 0) == 0;
  const std::string name = is_option ? word.substr(0, word.find('=')) : word;
  const std::vector<std::string> known = is_option ? option_names(app) : command_names(app);
  const std::string nearest = core::nearest_name(name, known);
  if (nearest.empty()) return "unexpected argument '" + name + "'";
  if (nearest == name) return "option '" + name + "' belongs after the command";
  const std::string what = (is_option ? "unknown option '" : "unknown command '") + name + "'" +
                           (is_near(name, nearest) ? "; did you mean '" + nearest + "'?" : ".");
  if (is_option) return what;
  return what + " Known are: " + CLI::detail::join(known, ", ");
}

}  // namespace

std::string explain_usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& parsed = parsed_app(app);
  std::vector<std::string> unknown = parsed.remaining();
  if (unknown.empty()) unknown = app.remaining();
  // A misspelt option also leaves its value or a required one missing: the unknown word is the cause.
  const std::string what = unknown.empty() ? error.what() : unknown_word(parsed, unknown.front());
  const std::string command = &parsed == &app ? app.get_name() : app.get_name() + " " + parsed.get_name();
  return what + "\nTry '" + command + " --help'.";
}

}  // namespace helixnav::apps
