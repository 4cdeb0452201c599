// SPDX-License-Identifier: BSD-3-Clause
#include "setting_options.hpp"

namespace helixnav::apps {
namespace {

const char* const by_reach = "auto";

/// "auto", or metres.
CLI::Validator length_between(double low, double high) {
  const CLI::Validator number = number_between(low, high);
  const auto objection = [number](std::string& word) { return word == by_reach ? std::string() : number(word); };
  return CLI::Validator(objection, number.get_description() + " or auto");
}

}  // namespace

CLI::Option* add_length(CLI::App& command, Settings& settings, const std::string& key, double low, double high,
                        const std::string& help) {
  const auto set = [&settings, key](const std::string& word) {
    settings.given_lengths_m.erase(key);
    if (word != by_reach) settings.given_lengths_m[key] = std::stod(word);
  };
  return command.add_option_function<std::string>("--" + key, set, help)
      ->check(length_between(low, high))
      ->default_str(by_reach)
      ->group(settings_group);
}

}  // namespace helixnav::apps
