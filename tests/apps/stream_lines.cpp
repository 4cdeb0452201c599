// SPDX-License-Identifier: BSD-3-Clause
#include "stream_lines.hpp"

#include <fstream>
#include <map>
#include <sstream>

namespace helixnav::apps {
namespace {

using Words = std::vector<std::string>;

/// Rows of a table as JSON objects by their time; rows with equal times together.
void add_table(const std::filesystem::path& path, std::map<double, Words>& rows) {
  std::ifstream table(path);
  std::string line;
  std::getline(table, line);
  const Words names = columns_of(line);
  while (std::getline(table, line)) {
    const Words cells = columns_of(line);
    std::string object = "{";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!cells[i].empty()) object += (i == 0 ? "\"" : ", \"") + names[i] + "\": " + cells[i];
    }
    rows[std::stod(cells[0])].push_back(object + "}");
  }
}

}  // namespace

Words columns_of(const std::string& row) {
  Words cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

Words lines_of(const std::filesystem::path& log, double seconds) {
  std::map<double, Words> odometry, detections;
  add_table(log / "odometry.csv", odometry);
  add_table(log / "detections.csv", detections);
  std::map<double, std::string> scans;
  for (const auto& [t, rows] : detections) {
    std::string list;
    for (const std::string& row : rows) list += (list.empty() ? "" : ", ") + row;
    scans[t] = R"({"detections": [)" + list + "]}";
  }
  Words lines;
  auto scan = scans.begin();
  for (const auto& [t, rows] : odometry) {
    if (t > seconds) break;
    for (; scan != scans.end() && scan->first < t; ++scan) lines.push_back(scan->second);
    for (const std::string& row : rows) lines.push_back(R"({"odometry": )" + row + "}");
  }
  return lines;
}

}  // namespace helixnav::apps
