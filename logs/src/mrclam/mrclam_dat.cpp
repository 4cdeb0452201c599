// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "input_files.hpp"
#include "mrclam/mrclam_rows.hpp"
#include "mrclam/mrclam_tables.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;

const char* const landmarks_file = "Landmark_Groundtruth.dat";
const char* const barcodes_file = "Barcodes.dat";

std::string name_of(int robot, const char* what) { return "Robot" + std::to_string(robot) + "_" + what + ".dat"; }

std::vector<std::string> all_names() {
  std::vector<std::string> names{landmarks_file, barcodes_file};
  for (int robot = 1; robot <= most_robots; ++robot) {
    for (const char* what : {"Odometry", "Measurement", "Groundtruth"}) names.push_back(name_of(robot, what));
  }
  return names;
}

TextByName read_all(const fs::path& path) {
  if (!fs::is_directory(path)) return read_archive(path, all_names());
  TextByName texts;
  for (const std::string& name : all_names()) {
    if (fs::exists(path / name)) texts[name] = read_file(path / name);
  }
  return texts;
}

/// The texts of one run.
class DatFiles {
 public:
  explicit DatFiles(const fs::path& path) : path_(path), texts_(read_all(path)) {}

  std::string full_name(const std::string& name) const { return (path_ / name).string(); }
  bool has(const std::string& name) const { return texts_.count(name) != 0; }

  template <class ReadRow>
  void for_each_row(const std::string& name, std::string_view columns, const ReadRow& read_row) const {
    const auto text = texts_.find(name);
    if (text == texts_.end()) throw core::InputError(full_name(name) + ": expected this file, found none");
    TextCursor cursor(text->second, full_name(name));
    logs::for_each_row(cursor, columns, read_row);
  }

 private:
  fs::path path_;
  TextByName texts_;
};

std::map<std::int64_t, int> read_barcodes(const DatFiles& files, const Subjects& subjects) {
  std::map<std::int64_t, int> subject_of;
  files.for_each_row(barcodes_file, "subject, barcode", [&](TextCursor& cursor) {
    const int subject = subjects.read(cursor);
    const std::int64_t barcode = cursor.integer("the number of a barcode");
    if (!subject_of.emplace(barcode, subject).second) {
      cursor.fail("barcode " + std::to_string(barcode) + " is another subject's already");
    }
  });
  if (subject_of.empty()) {
    throw core::InputError(files.full_name(barcodes_file) + ": expected rows of a subject and its barcode, found none");
  }
  return subject_of;
}

/// A robot without commands is not part of the team; other files of it show that it was meant to be.
void remark_on_missing(const DatFiles& files, int number, std::vector<std::string>& remarks) {
  for (const char* what : {"Measurement", "Groundtruth"}) {
    if (!files.has(name_of(number, what))) continue;
    remarks.push_back("warning: robot " + std::to_string(number) + " is left out: " + name_of(number, what) +
                      " is there, and " + files.full_name(name_of(number, "Odometry")) + " is missing");
    return;
  }
}

/// Robots beyond those that are read: their numbers are those of landmarks.
void remark_on_numbers_beyond(const fs::path& path, std::vector<std::string>& remarks) {
  std::vector<std::string> names;
  if (fs::is_directory(path)) {
    for (const auto& entry : fs::directory_iterator(path)) names.push_back(entry.path().filename().string());
  } else {
    names = names_in_archive(path);
  }
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    const std::string head = "Robot", tail = "_Odometry.dat";
    if (name.rfind(head, 0) != 0 || !ends_with(name, tail)) continue;
    const std::string digits = name.substr(head.size(), name.size() - head.size() - tail.size());
    if (digits.size() == 1 && digits[0] >= '1' && digits[0] <= '0' + most_robots) continue;
    remarks.push_back("warning: " + name + " is left out: robots have the numbers 1 to " + std::to_string(most_robots) +
                      ", landmarks those from there on");
  }
}

MrclamTables::Robot read_robot(const DatFiles& files, int number, const std::map<std::int64_t, int>& subject_of) {
  MrclamTables::Robot robot;
  robot.file = files.full_name(name_of(number, "Odometry"));
  files.for_each_row(name_of(number, "Odometry"), "time, speed, turn rate",
                     [&](TextCursor& cursor) { robot.commands.push_back(read_command(cursor)); });
  files.for_each_row(name_of(number, "Measurement"), "time, barcode, range, bearing", [&](TextCursor& cursor) {
    MrclamTables::Sighting sighting;
    sighting.t_ns = read_time(cursor);
    const auto subject = subject_of.find(cursor.integer("the number of a barcode"));
    sighting.subject = subject == subject_of.end() ? nobody : subject->second;
    read_range_and_bearing(cursor, sighting);
    robot.sightings.push_back(sighting);
  });
  if (files.has(name_of(number, "Groundtruth"))) {
    files.for_each_row(name_of(number, "Groundtruth"), "time, x, y, heading",
                       [&](TextCursor& cursor) { robot.truth.push_back(read_true_pose(cursor)); });
  }
  return robot;
}

}  // namespace

MrclamTables read_mrclam_dat(const fs::path& folder_or_archive) {
  const DatFiles files(folder_or_archive);
  MrclamTables tables;
  if (files.has(landmarks_file)) {
    files.for_each_row(landmarks_file, "subject, x, y, sigma x, sigma y",
                       [&](TextCursor& cursor) { tables.landmarks.push_back(read_landmark(cursor)); });
  }
  const std::map<std::int64_t, int> subject_of = read_barcodes(files, Subjects(tables.landmarks));
  for (int robot = 1; robot <= most_robots; ++robot) {
    if (files.has(name_of(robot, "Odometry"))) {
      tables.robots[robot] = read_robot(files, robot, subject_of);
    } else {
      remark_on_missing(files, robot, tables.remarks);
    }
  }
  remark_on_numbers_beyond(folder_or_archive, tables.remarks);
  return tables;
}

}  // namespace helixnav::logs
