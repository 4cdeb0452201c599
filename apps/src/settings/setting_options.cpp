// SPDX-License-Identifier: BSD-3-Clause
#include "setting_options.hpp"

namespace helixnav::apps {
namespace {

const char* const automatic = "auto";

/// "auto", or a number.
CLI::Validator automatic_or_between(double low, double high) {
  const CLI::Validator number = number_between(low, high);
  const auto objection = [number](std::string& word) { return word == automatic ? std::string() : number(word); };
  return CLI::Validator(objection, number.get_description() + " or auto");
}

}  // namespace

CLI::Option* add_length(CLI::App& command, Settings& settings, const std::string& key, double low, double high,
                        const std::string& help) {
  const auto set = [&settings, key](const std::string& word) {
    settings.given_lengths_m.erase(key);
    if (word != automatic) settings.given_lengths_m[key] = std::stod(word);
  };
  return command.add_option_function<std::string>("--" + key, set, help)
      ->check(automatic_or_between(low, high))
      ->default_str(automatic)
      ->group(settings_group);
}

CLI::Option* add_automatic(CLI::App& command, const char* name, std::optional<double>& value, double low, double high,
                           const char* help) {
  const auto set = [&value](const std::string& word) {
    value.reset();
    if (word != automatic) value = std::stod(word);
  };
  return command.add_option_function<std::string>(name, set, help)
      ->check(automatic_or_between(low, high))
      ->default_str(automatic)
      ->group(settings_group);
}

}  // namespace helixnav::apps
