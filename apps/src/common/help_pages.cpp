// SPDX-License-Identifier: BSD-3-Clause
#include "help_pages.hpp"

#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

namespace helixnav::apps {
namespace {

class ShortHelp : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    all_ = mode == CLI::AppFormatMode::All;
    return CLI::Formatter::make_help(app, std::move(name), mode);
  }
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (all_ || group != settings_group) return CLI::Formatter::make_group(std::move(group), is_positional, options);
    return "\n" + std::string(settings_group) + ": " + std::to_string(options.size()) + ", shown by --help-all\n";
  }

 private:
  mutable bool all_ = false;  // make_group does not learn it otherwise
};

}  // namespace

void use_short_help(CLI::App& app) {
  app.formatter(std::make_shared<ShortHelp>());
  app.set_help_all_flag("--help-all", "Print this help with all settings and exit");
}

std::vector<std::string> without_help_word(const CLI::App& app, std::vector<std::string> words) {
  if (words.size() < 2 || words[1] != "help") return words;
  words.erase(words.begin() + 1);
  const auto is_asked = [&](const CLI::App* command) { return words.size() > 1 && command->check_name(words[1]); };
  const bool is_command = words.size() > 1 && words[1].rfind('-', 0) != 0;
  if (!is_command || !app.get_subcommands(is_asked).empty()) words.emplace_back("--help");
  return words;
}

}  // namespace helixnav::apps
