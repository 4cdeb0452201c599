// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/own_log.hpp"
#include "own/live/json_rows.hpp"
#include "own/tables/own_tables.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;
using Table = OwnTables::Table;

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
  for (const Table table : OwnTables::all) {
    const fs::path path = folder / (std::string(OwnTables::name_of(table)) + ".csv");
    if (fs::exists(path)) read_table(path, table, tables);
  }
  return tables.finish(fs::absolute(folder).lexically_normal().filename().string());
}

void read_json_lines(const fs::path& path, OwnTables& tables) {
  LineReader lines(path);
  JsonRows rows(path.string());
  std::string_view line;
  while (lines.next(line)) rows.read(line, lines.line_number(), tables);
  for (const Table table : {Table::odometry, Table::detections}) {
    if (rows.has(table)) continue;
    throw core::InputError(path.string() + ": no line of " + std::string(OwnTables::name_of(table)));
  }
}

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
  read_json_lines(path, tables);
  return tables.finish(path.stem().string());
}

}  // namespace helixnav::logs
