// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "helixnav/logs/own_log.hpp"
#include "own_tables.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;
using Table = OwnTables::Table;

constexpr std::array all_tables{Table::odometry, Table::detections, Table::fixes, Table::truth_poses,
                                Table::truth_landmarks};

/// The table called so; nothing for another name.
std::optional<Table> table_called(std::string_view name) {
  for (const Table table : all_tables) {
    if (OwnTables::name_of(table) == name) return table;
  }
  return std::nullopt;
}

void read_table(const fs::path& path, Table table, OwnTables& tables) {
  TableReader reader(path);
  const TableColumns columns(path.string(), OwnTables::columns_of(table), reader.header(), reader.header_columns(),
                             reader.header_line());
  tables.begin(table, columns);
  std::vector<Cell> cells;
  std::size_t rows = 0;
  for (; reader.next(cells); ++rows) tables.add(table, Row(columns, cells, reader.line_number()));
  const bool needed = table == Table::odometry || table == Table::detections;
  if (rows == 0 && needed) columns.fail_header("a line of columns and no rows below it");
}

std::string files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < 10; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return text.empty() ? "nothing" : text;
}

OwnLog read_folder(const fs::path& folder) {
  for (const char* name : {"odometry.csv", "detections.csv"}) {
    if (fs::exists(folder / name)) continue;
    throw core::InputError((folder / name).string() +
                           ": a log needs odometry.csv and detections.csv; found in the folder: " + files_in(folder));
  }
  OwnTables tables(false);
  for (const Table table : all_tables) {
    const fs::path path = folder / (std::string(OwnTables::name_of(table)) + ".csv");
    if (fs::exists(path)) read_table(path, table, tables);
  }
  return tables.finish(fs::absolute(folder).lexically_normal().filename().string());
}

using Json = nlohmann::ordered_json;

/// A file of JSON Lines: {"odometry": {"t": 0.1, …}}, {"detections": [{…}, {…}]}, with the names of files and columns.
class JsonLines {
 public:
  explicit JsonLines(const fs::path& path) : path_(path.string()), lines_(path) {}

  void read(OwnTables& tables) {
    std::string_view line;
    while (lines_.next(line)) {
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      read_line(line, tables);
    }
    for (const Table table : {Table::odometry, Table::detections}) {
      if (state_of(table).columns == nullptr) {
        throw core::InputError(path_ + ": no line of " + std::string(OwnTables::name_of(table)));
      }
    }
  }

 private:
  struct State {
    std::vector<std::string> header;
    std::unique_ptr<TableColumns> columns;
  };
  State& state_of(Table table) { return states_[static_cast<std::size_t>(table)]; }

  [[noreturn]] void fail(std::size_t column, const std::string& message) const {
    fail_at(path_, lines_.line_number(), column, message);
  }

  /// Where a name stands in quotes in the line, from 1.
  static std::size_t place_of(const std::string& name, std::string_view line) {
    const std::size_t at = line.find('"' + name + '"');
    return at == std::string_view::npos ? 1 : at + 1;
  }

  void read_line(std::string_view line, OwnTables& tables) {
    Json object;
    try {
      object = Json::parse(line);
    } catch (const Json::parse_error& error) {
      fail(error.byte,
           "no JSON; each line is one object, as {\"odometry\": {\"t\": 0.1, \"v_mps\": 1, \"omega_radps\": 0}}");
    }
    if (!object.is_object()) fail(1, "expected an object in braces");
    for (const auto& [name, rows] : object.items()) {
      const std::optional<Table> table = table_called(name);
      if (!table) fail_unknown(name, line);
      if (rows.is_array()) {
        for (const Json& row : rows) add_row(*table, row, line, tables);
      } else {
        add_row(*table, rows, line, tables);
      }
    }
  }

  [[noreturn]] void fail_unknown(const std::string& name, std::string_view line) const {
    std::vector<std::string> names;
    for (const Table table : all_tables) names.emplace_back(OwnTables::name_of(table));
    fail(place_of(name, line), "unknown name '" + name + "'; the nearest is '" + core::nearest_name(name, names) + "'");
  }

  void add_row(Table table, const Json& row, std::string_view line, OwnTables& tables) {
    if (!row.is_object()) fail(place_of(std::string(OwnTables::name_of(table)), line), "expected a row in braces");
    header_.clear();
    texts_.clear();
    places_.clear();
    for (const auto& [name, value] : row.items()) {
      header_.push_back(name);
      places_.push_back(place_of(name, line));
      if (value.is_structured() || value.is_boolean())
        fail(places_.back(), "expected a number or text for '" + name + "'");
      texts_.push_back(value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
    }
    cells_.clear();
    for (std::size_t i = 0; i < texts_.size(); ++i) cells_.push_back({texts_[i], places_[i]});
    tables.add(table, Row(columns_of(table, tables), cells_, lines_.line_number()));
  }

  const TableColumns& columns_of(Table table, OwnTables& tables) {
    State& state = state_of(table);
    if (state.columns == nullptr || state.header != header_) {
      state.header = header_;
      state.columns =
          std::make_unique<TableColumns>(path_, OwnTables::columns_of(table), header_, places_, lines_.line_number());
      tables.begin(table, *state.columns);
    }
    return *state.columns;
  }

  std::string path_;
  LineReader lines_;
  std::array<State, OwnTables::table_count> states_;
  std::vector<std::string> header_, texts_;
  std::vector<std::size_t> places_;
  std::vector<Cell> cells_;
};

bool is_json_lines(const fs::path& path) {
  if (fs::is_directory(path)) return false;
  if (path.extension() == ".jsonl" || path.extension() == ".ndjson") return true;
  std::ifstream file(path, std::ios::binary);
  char first = ' ';
  while (file.get(first) && (first == ' ' || first == '\n' || first == '\r' || first == '\t')) {
  }
  return file && first == '{';
}

}  // namespace

bool is_own_log(const fs::path& path) {
  if (!fs::is_directory(path)) return fs::exists(path) && is_json_lines(path);
  return fs::exists(path / "odometry.csv") || fs::exists(path / "detections.csv") || fs::exists(path / "vehicle.toml");
}

fs::path vehicle_beside(const fs::path& log) {
  const fs::path folder = fs::is_directory(log) ? log : log.has_parent_path() ? log.parent_path() : fs::path(".");
  const fs::path file = folder / "vehicle.toml";
  return fs::exists(file) ? file : fs::path();
}

OwnLog read_own_log(const fs::path& path) {
  if (fs::is_directory(path)) return read_folder(path);
  OwnTables tables(true);
  JsonLines(path).read(tables);
  return tables.finish(path.stem().string());
}

}  // namespace helixnav::logs
