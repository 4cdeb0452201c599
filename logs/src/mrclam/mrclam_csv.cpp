// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string_view>

#include <zlib.h>

#include "helixnav/core/errors.hpp"
#include "input_files.hpp"
#include "mrclam/mrclam_rows.hpp"
#include "mrclam/mrclam_tables.hpp"
#include "plausible.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(gzFile_s* file) const { gzclose(file); }
};

/// zlib reads both compressed and plain files.
std::string read_packed(const fs::path& path) {
  constexpr std::size_t most_bytes = 512u << 20;
  const std::unique_ptr<gzFile_s, CloseFile> file(gzopen(path.c_str(), "rb"));
  if (!file) throw core::InputError(path.string() + ": expected a file that can be read");
  std::string text;
  std::array<char, 1 << 16> block{};
  for (;;) {
    const int got = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()));
    if (got < 0) throw core::InputError(path.string() + ": expected a gzip file that can be read to its end");
    if (got == 0) {
      int code = Z_OK;
      gzerror(file.get(), &code);
      if (code != Z_BUF_ERROR) return text;
      throw core::InputError(path.string() + ": expected a whole gzip file, found one that was cut");
    }
    text.append(block.data(), static_cast<std::size_t>(got));
    if (text.size() > most_bytes) throw core::InputError(path.string() + ": expected at most 512 MiB, found more");
  }
}

fs::path required(const fs::path& folder, const std::string& name) {
  const fs::path path = plain_or_packed(folder, name);
  if (path.empty()) throw core::InputError((folder / name).string() + ": expected this file (or .gz), found none");
  return path;
}

/// Calls read_row for each row of a comma-separated file, compressed or not.
template <class ReadRow>
void for_each_row(const fs::path& path, std::string_view columns, const ReadRow& read_row) {
  const std::string text = read_packed(path);
  TextCursor cursor(text, path.string(), ',');
  for_each_row(cursor, columns, read_row);
}

int read_robot(TextCursor& cursor) {
  return static_cast<int>(cursor.number_between(1, most_robots, "the number of a robot"));
}

void read_commands(const fs::path& path, MrclamTables& tables) {
  int last = 0;
  for_each_row(path, "robot, time, speed, turn rate", [&](TextCursor& cursor) {
    const int number = read_robot(cursor);
    MrclamTables::Robot& robot = tables.robots[number];
    if (number != last && !robot.commands.empty()) {
      cursor.fail("robot " + std::to_string(number) + " is here a second time: expected all its commands in one place");
    }
    last = number;
    if (robot.commands.empty()) robot.file = path.string() + ':' + std::to_string(cursor.line());
    robot.commands.push_back(read_command(cursor));
  });
  if (tables.robots.empty()) throw core::InputError(path.string() + ": expected commands of robots, found none");
}

void read_landmarks(const fs::path& path, MrclamTables& tables) {
  if (path.empty()) return;
  for_each_row(path, "subject, x, y, sigma x, sigma y",
               [&](TextCursor& cursor) { tables.landmarks.push_back(read_landmark(cursor)); });
}

void read_sightings(const fs::path& path, MrclamTables& tables) {
  const Subjects subjects(tables.landmarks);
  for_each_row(path, "robot, time, barcode, subject, range, bearing", [&](TextCursor& cursor) {
    const int number = read_robot(cursor);
    const auto robot = tables.robots.find(number);
    if (robot == tables.robots.end()) cursor.fail("robot " + std::to_string(number) + " has no commands");
    MrclamTables::Sighting sighting;
    sighting.t_ns = read_time(cursor);
    cursor.integer("the number of a barcode");
    sighting.subject = subjects.read(cursor);
    read_range_and_bearing(cursor, sighting);
    robot->second.sightings.push_back(sighting);
  });
}

void read_truth(const fs::path& path, MrclamTables& tables) {
  if (path.empty()) return;
  for_each_row(path, "robot, time, x, y, heading", [&](TextCursor& cursor) {
    const int number = read_robot(cursor);
    tables.robots[number].truth.push_back(read_true_pose(cursor));
  });
}

}  // namespace

fs::path plain_or_packed(const fs::path& folder, const std::string& name) {
  if (fs::exists(folder / name)) return folder / name;
  if (fs::exists(folder / (name + ".gz"))) return folder / (name + ".gz");
  return {};
}

MrclamTables read_mrclam_csv(const fs::path& folder) {
  MrclamTables tables;
  read_commands(required(folder, "odometry.csv"), tables);
  read_landmarks(plain_or_packed(folder, "landmarks_true.csv"), tables);
  read_sightings(required(folder, "measurements.csv"), tables);
  read_truth(plain_or_packed(folder, "groundtruth.csv"), tables);
  return tables;
}

}  // namespace helixnav::logs
