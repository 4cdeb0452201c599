// SPDX-License-Identifier: BSD-3-Clause
#include "json_rows.hpp"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "helixnav/core/nearest_name.hpp"

namespace helixnav::logs {
namespace {

using Json = nlohmann::ordered_json;
using Table = OwnTables::Table;

/// The table of that name; nothing for another name.
std::optional<Table> table_called(std::string_view name) {
  for (const Table table : OwnTables::all) {
    if (OwnTables::name_of(table) == name) return table;
  }
  return std::nullopt;
}

/// Position of a quoted name in the line, from 1.
std::size_t place_of(const std::string& name, std::string_view line) {
  const std::size_t at = line.find('"' + name + '"');
  return at == std::string_view::npos ? 1 : at + 1;
}

}  // namespace

struct JsonRows::Line {
  JsonRows& rows;
  std::string_view text;
  std::size_t number;
  OwnTables& tables;

  [[noreturn]] void fail(std::size_t column, const std::string& message) const {
    fail_at(rows.path_, number, column, message);
  }

  /// JSON takes the last of two values with the same name, and nobody knows which was meant.
  Json parsed() const {
    std::vector<std::vector<std::string>> open;  // names so far of the objects about what is read
    return Json::parse(text, [&](int, Json::parse_event_t event, const Json& read) {
      if (event == Json::parse_event_t::object_start) open.emplace_back();
      if (event == Json::parse_event_t::object_end) open.pop_back();
      if (event != Json::parse_event_t::key) return true;
      std::vector<std::string>& names = open.back();
      names.push_back(read.get<std::string>());
      if (std::find(names.begin(), names.end() - 1, names.back()) != names.end() - 1) {
        fail(place_of(names.back(), text), "'" + names.back() + "' is given twice");
      }
      return true;
    });
  }

  Json object() const {
    Json object;
    try {
      object = parsed();
    } catch (const Json::out_of_range&) {
      fail(1, "a number that is larger than any that can be held (1.8e308)");
    } catch (const Json::exception& error) {
      const auto* placed = dynamic_cast<const Json::parse_error*>(&error);
      const bool has_no_number = text.find("NaN") != std::string::npos || text.find("Infinity") != std::string::npos;
      fail(placed != nullptr ? placed->byte : 1,
           has_no_number
               ? "NaN and Infinity are no numbers of JSON: leave out what has no value"
               : "no JSON; each line is one object, as {\"odometry\": {\"t\": 0.1, \"v_mps\": 1, \"omega_radps\": 0}}");
    }
    if (!object.is_object()) fail(1, "expected an object in braces");
    return object;
  }

  [[noreturn]] void fail_unknown(const std::string& name) const {
    std::vector<std::string> names;
    for (const Table table : OwnTables::all) names.emplace_back(OwnTables::name_of(table));
    const std::string near = core::near_name(name, names);
    std::string known;
    for (const std::string& one : names) known += (known.empty() ? "; known are " : ", ") + one;
    fail(place_of(name, text),
         "unknown name '" + name + '\'' + (near.empty() ? known : "; the nearest is '" + near + '\''));
  }

  void add(Table table, const Json& row) {
    if (!row.is_object()) fail(place_of(std::string(OwnTables::name_of(table)), text), "expected a row in braces");
    rows.header_.clear();
    rows.texts_.clear();
    rows.places_.clear();
    for (const auto& [name, value] : row.items()) {
      rows.header_.push_back(name);
      rows.places_.push_back(place_of(name, text));
      if (value.is_structured() || value.is_boolean())
        fail(rows.places_.back(), "expected a number or text for '" + name + "'");
      rows.texts_.push_back(value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
    }
    rows.cells_.clear();
    for (std::size_t i = 0; i < rows.texts_.size(); ++i) rows.cells_.push_back({rows.texts_[i], rows.places_[i]});
    tables.add(table, Row(rows.columns_of(table, number, tables), rows.cells_, number));
  }
};

void JsonRows::read(std::string_view line, std::size_t number, OwnTables& tables) {
  list_ = false;
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  Line reading{*this, line, number, tables};
  const Json object = reading.object();
  for (const auto& [name, value] : object.items()) {
    const std::optional<Table> table = table_called(name);
    if (!table) reading.fail_unknown(name);
    if (!value.is_array()) {
      reading.add(*table, value);
      continue;
    }
    list_ = list_ || *table == Table::detections;
    for (const Json& row : value) reading.add(*table, row);
  }
}

const TableColumns& JsonRows::columns_of(Table table, std::size_t number, OwnTables& tables) {
  State& state = states_[static_cast<std::size_t>(table)];
  if (state.columns == nullptr || state.header != header_) {
    auto columns = std::make_unique<TableColumns>(path_, OwnTables::columns_of(table), header_, places_, number);
    tables.begin(table, *columns);
    state.header = header_;
    state.columns = std::move(columns);
  }
  return *state.columns;
}

}  // namespace helixnav::logs
