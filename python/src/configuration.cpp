// SPDX-License-Identifier: BSD-3-Clause
#include "configuration.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include <CLI/CLI.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "settings/config_file.hpp"
#include "settings/memory_limit.hpp"
#include "settings/vehicle_option.hpp"

namespace helixnav::python {
namespace {

std::string text_of(const py::handle& value) {
  const std::string text = py::str(value);
  if (text == "True") return "true";  // of Python's type or of NumPy's
  if (text == "False") return "false";
  return text;
}

/// "--key=value" of each.
void add_words(const py::dict& options, const std::string& section, std::vector<std::string>& words) {
  for (const auto& [name, value] : options) {
    const std::string key = section + std::string(py::str(name));
    if (py::isinstance<py::dict>(value)) {
      add_words(py::reinterpret_borrow<py::dict>(value), key + ".", words);
    } else {
      words.push_back("--" + key + "=" + text_of(value));
    }
  }
}

void refuse_unknown(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  for (const CLI::Option* option : apps::configurable_options(app)) {
    for (const std::string& name : option->get_lnames()) known.push_back(name);
  }
  for (const std::string& word : words) {
    const std::string key = word.substr(2, word.find('=') - 2);
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string near = core::near_name(key, known);
    throw core::InputError("unknown option '" + key + '\'' +
                           (near.empty() ? std::string() : "; the nearest is '" + near + '\''));
  }
}

/// What it is read with, and nothing else.
bool is_of_log(const std::string& key) {
  constexpr const char* sections[] = {"log.", "victoria_park.", "car_park.", "plaza.", "mrclam.", "gps."};
  if (key == "gps.gate_probability") return false;  // of any fix
  return std::any_of(std::begin(sections), std::end(sections),
                     [&](const char* section) { return key.rfind(section, 0) == 0; });
}

}  // namespace

void refuse_unheeded(const Configuration& configuration, const std::string& navigates, bool by_identities) {
  for (const std::string& key : configuration.keys) {
    if (is_of_log(key)) {
      throw core::InputError(key + ": is for reading a log; " + navigates +
                             " takes events as they are (read_log and simulate take the option)");
    }
  }
  const apps::Settings& settings = configuration.settings;
  const bool is_filter = navigates == "FastSlam";
  if (settings.fastslam.chosen && !is_filter) {
    throw core::InputError("filter.method: " + navigates + " is no particle filter; helixnav.FastSlam is");
  }
  if (settings.known_association && !by_identities) {
    throw core::InputError("association.method: " + navigates + " takes no identities; helixnav.NamedNavigator does");
  }
}

Configuration configuration_of(const py::dict& options, const std::string& vehicle, const std::string& log,
                               Filter filter) {
  CLI::App app;
  Configuration configuration;
  apps::add_settings(app, configuration.settings);
  std::vector<std::string> words;
  add_words(options, "", words);
  refuse_unknown(app, words);
  for (const std::string& word : words) configuration.keys.push_back(word.substr(2, word.find('=') - 2));
  if (filter == Filter::fastslam) words.emplace_back("--filter=fastslam");
  std::reverse(words.begin(), words.end());  // as parse wants them
  try {
    app.parse(std::move(words));
    const apps::FastSlamSettings& chosen = configuration.settings.fastslam;
    if (filter == Filter::compressed_ekf) {
      apps::require_compressed_ekf(app, apps::options_given(app), chosen,
                                   "a stream is navigated by the compressed EKF");
    }
    apps::check_filter(app, apps::options_given(app), chosen);
    apps::refuse_memory_limit(configuration.settings, "a process of Python is its user's");
    apps::apply_vehicle(app, vehicle, log, configuration.settings);
  } catch (const CLI::ParseError& error) {
    throw core::InputError(error.what());
  }
  configuration.text = apps::dump_config(app);
  return configuration;
}

}  // namespace helixnav::python
