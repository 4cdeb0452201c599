// SPDX-License-Identifier: BSD-3-Clause
#include "toml_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "own/tables/table_reader.hpp"
#include "units.hpp"

namespace helixnav::logs {
namespace {

std::string in_words(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a section";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "text";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    default:
      return "a date or time";
  }
}

}  // namespace

const toml::node* TomlSection::take(std::string_view key) {
  known_.emplace_back(key);
  return table_.get(key);
}

void TomlSection::fail_at_node(const toml::node& node, const std::string& message) const {
  const toml::source_position at = node.source().begin;
  fail_at(path_, at.line, at.column, message);
}

void TomlSection::fail(std::string_view key, const std::string& message) const {
  const toml::node* node = table_.get(key);
  fail_at_node(node != nullptr ? *node : static_cast<const toml::node&>(table_), message);
}

double TomlSection::number_of(const toml::node& node, std::string_view key, double low, double high,
                              double factor) const {
  const std::optional<double> value = node.value<double>();
  if (!node.is_number() || !value) fail_at_node(node, full(key) + ": expected a number, found " + in_words(node));
  const double scaled = *value * factor;
  if (scaled >= low && scaled <= high) return scaled;
  std::array<char, 128> range{};
  std::snprintf(range.data(), range.size(), ": expected a number from %g to %g, found %g", low / factor, high / factor,
                *value);
  fail_at_node(node, full(key) + range.data());
}

std::optional<double> TomlSection::number(std::string_view key, double low, double high) {
  const toml::node* node = take(key);
  if (node == nullptr) return {};
  return number_of(*node, key, low, high, 1.0);
}

std::pair<const toml::node*, double> TomlSection::angle_node(const std::string& key, std::string_view suffix) {
  const std::string in_radians = key + "_rad" + std::string(suffix);
  const std::string in_degrees = key + "_deg" + std::string(suffix);
  const toml::node* radians = take(in_radians);
  const toml::node* degrees = take(in_degrees);
  if (radians != nullptr && degrees != nullptr) {
    fail_at_node(*degrees, full(in_degrees) + ": " + in_radians + " is given, too; keep one");
  }
  return radians != nullptr ? std::pair(radians, 1.0) : std::pair(degrees, rad_per_deg);
}

std::optional<double> TomlSection::angle(const std::string& key, double low_rad, double high_rad,
                                         std::string_view suffix) {
  const auto [node, factor] = angle_node(key, suffix);
  if (node == nullptr) return {};
  const std::string name = key + (factor == 1.0 ? "_rad" : "_deg") + std::string(suffix);
  return number_of(*node, name, low_rad, high_rad, factor);
}

std::optional<std::pair<double, double>> TomlSection::angles(const std::string& key, double low_rad, double high_rad) {
  const auto [node, factor] = angle_node(key, "");
  if (node == nullptr) return {};
  const std::string name = key + (factor == 1.0 ? "_rad" : "_deg");
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2) {
    fail_at_node(*node, full(name) + ": expected a list of two angles, from the right to the left, as [-90, 90]");
  }
  const double first = number_of(*array->get(0), name, low_rad, high_rad, factor);
  const double second = number_of(*array->get(1), name, low_rad, high_rad, factor);
  if (first >= second) fail_at_node(*node, full(name) + ": expected the smaller angle first");
  return std::pair(first, second);
}

std::optional<std::string> TomlSection::text(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) return {};
  const auto value = node->value<std::string>();
  if (!value) fail_at_node(*node, full(key) + ": expected text in quotes, found " + in_words(*node));
  return value;
}

std::optional<TomlSection> TomlSection::section(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) return {};
  const toml::table* table = node->as_table();
  if (table == nullptr)
    fail_at_node(*node, full(key) + ": expected a section [" + full(key) + "], found " + in_words(*node));
  return TomlSection(*table, path_, full(key));
}

std::vector<TomlSection> TomlSection::sections(std::string_view key) {
  const toml::node* node = take(key);
  std::vector<TomlSection> all;
  if (node == nullptr) return all;
  if (const toml::table* one = node->as_table()) all.emplace_back(*one, path_, full(key));
  const toml::array* array = node->as_array();
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const toml::table* one = array->get(i)->as_table();
    if (one == nullptr) fail_at_node(*array->get(i), full(key) + ": expected [[" + full(key) + "]] sections");
    all.emplace_back(*one, path_, full(key));
  }
  if (all.empty())
    fail_at_node(*node, full(key) + ": expected a section [[" + full(key) + "]], found " + in_words(*node));
  return all;
}

void TomlSection::refuse_rest() const {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const toml::source_position at = key.source().begin;
    const std::string near = core::near_name(name, known_);
    fail_at(path_, at.line, at.column,
            "unknown key '" + full(name) + '\'' +
                (near.empty() ? std::string() : "; the nearest is '" + full(near) + '\''));
  }
}

}  // namespace helixnav::logs
