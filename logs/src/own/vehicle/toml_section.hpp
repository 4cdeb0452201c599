// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace helixnav::logs {

/// A table of a TOML file whose keys are taken one by one; any not taken at the end is an error that suggests the
/// nearest key of this section. All errors are core::InputError with file:line:column.
class TomlSection {
 public:
  TomlSection(const toml::table& table, std::string path, std::string name)
      : table_(table), path_(std::move(path)), name_(std::move(name)) {}

  std::optional<double> number(std::string_view key, double low, double high);
  /// The value of key_rad or key_deg, in radians, between the bounds [rad].
  std::optional<double> angle(const std::string& key, double low_rad, double high_rad, std::string_view suffix = "");
  std::optional<std::string> text(std::string_view key);
  /// An array of two angles in order, key_rad or key_deg.
  std::optional<std::pair<double, double>> angles(const std::string& key, double low_rad, double high_rad);
  std::optional<TomlSection> section(std::string_view key);
  std::vector<TomlSection> sections(std::string_view key);

  void refuse_rest() const;
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;

 private:
  const toml::node* take(std::string_view key);
  double number_of(const toml::node& node, std::string_view key, double low, double high, double factor) const;
  [[noreturn]] void fail_at_node(const toml::node& node, const std::string& message) const;
  std::string full(std::string_view key) const {
    return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
  }
  std::pair<const toml::node*, double> angle_node(const std::string& key, std::string_view suffix);

  const toml::table& table_;
  std::string path_;
  std::string name_;
  std::vector<std::string> known_;
};

}  // namespace helixnav::logs
