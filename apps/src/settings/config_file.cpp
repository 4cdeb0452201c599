// SPDX-License-Identifier: BSD-3-Clause
#include "config_file.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include <CLI/CLI.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "helixnav/files/file.hpp"

namespace helixnav::apps {
namespace {

std::string section_of(const std::string& key) { return key.substr(0, key.find('.')); }

/// Line of the text, from 1, that begins with `name` in its section, or with both and a dot outside of any: CLI11's parser keeps no line
/// numbers.
int line_of(const std::string& text, const std::string& section, const std::string& name) {
  std::istringstream file(text);
  std::string line;
  std::string current;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    if (line[first] == '[') current = line.substr(first + 1, line.find(']') - first - 1);
    const auto starts_with = [&](const std::string& word) { return line.compare(first, word.size(), word) == 0; };
    if (starts_with(name) && (current == section || section.empty())) return number;
    if (current.empty() && starts_with(section + '.' + name)) return number;
  }
  return 0;
}

CLI::ValidationError config_error(const std::string& path, int line, const std::string& what) {
  return CLI::ValidationError(path + ":" + std::to_string(line), what);
}

/// All settings at once are 20 kB.
constexpr std::size_t most_config_bytes = 1u << 20;

std::string config_text(const std::string& path) {
  try {
    return files::read_whole_file(path, most_config_bytes);
  } catch (const core::InputError& error) {
    throw CLI::FileError(std::string("cannot read this configuration file: ") + error.what());
  }
}

/// As it may stand in a message.
std::string shortened(const std::string& key) {
  constexpr std::size_t longest = 60;
  return key.size() <= longest ? key : key.substr(0, longest) + "...";
}

/// `given`: by the command line, which wins, or by the file so far, which may set a key only once.
void apply_item(const std::vector<CLI::Option*>& options, const CLI::ConfigItem& item, const std::string& path,
                const std::string& text, std::map<const CLI::Option*, bool>& given) {
  const std::string key = shortened(item.fullname());
  const std::string section = item.parents.empty() ? "" : item.parents.front();
  const auto is_called = [&](const CLI::Option* option) {  // now or in an earlier version
    const std::vector<std::string>& names = option->get_lnames();
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  const auto found = std::find_if(options.begin(), options.end(), is_called);
  if (found == options.end()) {
    std::vector<std::string> keys;
    keys.reserve(options.size());
    const bool known_section = std::any_of(options.begin(), options.end(), [&](const CLI::Option* option) {
      return section_of(key_of(*option)) == section;
    });
    for (const CLI::Option* option : options) {
      if (!known_section || section_of(key_of(*option)) == section) keys.push_back(key_of(*option));
    }
    const std::string near = core::near_name(key, keys);
    throw config_error(path, line_of(text, section, item.name),
                       "unknown key '" + key + "'; " +
                           (near.empty() ? "'helixnav config --dump' lists all" : "the nearest is '" + near + '\''));
  }
  CLI::Option& option = **found;
  const auto [known, fresh] = given.emplace(&option, true);
  if (!fresh && known->second) {
    throw config_error(path, line_of(text, section, item.name), "'" + key + "' is given a second time");
  }
  if (!fresh) return;
  try {
    option.add_result(item.inputs);
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    throw config_error(path, line_of(text, section, item.name), error.what());
  }
}

}  // namespace

std::string key_of(const CLI::Option& option) { return option.get_lnames().front(); }

std::vector<CLI::Option*> configurable_options(const CLI::App& app) {
  std::vector<CLI::Option*> options;
  for (CLI::Option* option : const_cast<CLI::App&>(app).get_options()) {
    if (!option->get_lnames().empty() && key_of(*option).find('.') != std::string::npos) options.push_back(option);
  }
  return options;
}

std::set<const CLI::Option*> options_given(const CLI::App& app) {
  std::set<const CLI::Option*> given;
  for (const CLI::Option* option : configurable_options(app)) {
    if (option->count() > 0) given.insert(option);
  }
  return given;
}

void apply_config_file(CLI::App& app, const std::string& path) {
  const std::string text = config_text(path);
  std::istringstream file(text);
  const std::vector<CLI::Option*> options = configurable_options(app);
  std::vector<CLI::ConfigItem> items;
  try {
    items = CLI::ConfigTOML().from_config(file);
  } catch (const CLI::ParseError& error) {
    throw CLI::ValidationError(path, error.what());
  }
  std::map<const CLI::Option*, bool> given;  // true: by the file
  for (const CLI::Option* option : options) {
    if (option->count() > 0) given[option] = false;
  }
  for (const CLI::ConfigItem& item : items) {
    if (item.name == "++" || item.name == "--") continue;  // CLI11's marks of section begin and end
    apply_item(options, item, path, text, given);
  }
}

std::string dump_config(const CLI::App& app) {
  std::ostringstream text;
  std::string section;
  for (const CLI::Option* option : configurable_options(app)) {
    const std::string key = key_of(*option);
    if (section_of(key) != section) {
      section = section_of(key);
      text << (text.tellp() > 0 ? "\n" : "") << '[' << section << "]\n";
    }
    const std::string value = option->count() > 0 ? option->results().back() : option->get_default_str();
    const bool is_text = value.find_first_not_of("0123456789+-.eE") != std::string::npos && value != "true" &&
                         value != "false" && value != "inf";
    text << "# " << option->get_description() << '\n';
    text << key.substr(section.size() + 1) << " = " << (is_text ? '"' + value + '"' : value) << '\n';
  }
  return text.str();
}

}  // namespace helixnav::apps
