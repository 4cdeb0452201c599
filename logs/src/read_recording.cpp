// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/read_recording.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/logs/own_log.hpp"
#include "input_files.hpp"
#include "mat_file.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;

constexpr const char* looked_for =
    "a folder or zip with DRS.txt, LASER.txt, GPS.txt and Sensors_manager.txt (ACFR); a folder with aa3_dr.mat and "
    "aa3_gpsx.mat (Victoria Park); data_set.mat (car park); VicPark_clean_data.mat (2D-I-SLSJF); text of ODOMETRY and "
    "LANDMARK lines (iSAM, GTSAM); text of VERTEX_SE2, EDGE_SE2 … lines (g2o); text of STEP, LANDMARK_C, LANDMARK_L "
    "lines (DLR); a folder with …_odometry.csv and …_ranges.csv (Plaza); your own: a folder with odometry.csv, "
    "detections.csv and vehicle.toml, or JSON Lines (docs/your_own_log.md)";

bool starts_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}
bool contains(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::optional<LogFormat> of_folder(const fs::path& folder) {
  if (fs::exists(folder / "DRS.txt") || fs::exists(folder / "LASER.txt")) {
    return LogFormat::acfr_ascii;
  }
  if (fs::exists(folder / "aa3_dr.mat")) {
    return LogFormat::victoria_park_mat;
  }
  if (fs::exists(folder / "data_set.mat")) {
    return LogFormat::car_park_mat;
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (ends_with(entry.path().string(), "_odometry.csv")) {
      return LogFormat::plaza;
    }
  }
  return std::nullopt;
}

std::optional<LogFormat> of_matlab_file(const fs::path& path) {
  const std::vector<std::string> variables = MatFile(path).variables();
  if (contains(variables, "Laser") && contains(variables, "Intensity")) {
    return LogFormat::car_park_mat;
  }
  if (contains(variables, "VicPark_clean_data")) {
    return LogFormat::slsjf_mat;
  }
  return std::nullopt;
}

/// By the first word that is not a comment; in DLR's old files LANDMARK comes after a STEP.
std::optional<LogFormat> of_text(std::string_view text, const fs::path& path) {
  TextCursor cursor(text, path.string());
  while (!cursor.at_end() && cursor.peek() == '#') {
    cursor.skip_line();
  }
  const std::string_view keyword = cursor.word();
  if (keyword == "ODOMETRY" || keyword == "LANDMARK") {
    return LogFormat::pose_landmark_text;
  }
  if (starts_with(keyword, "VERTEX_") || starts_with(keyword, "EDGE_")) {
    return LogFormat::g2o;
  }
  if (keyword == "STEP" || keyword == "LANDMARK_C" || keyword == "LANDMARK_L") {
    return LogFormat::dlr;
  }
  return std::nullopt;
}

std::optional<LogFormat> of_file(const fs::path& path) {
  const std::string content = read_file(path);
  if (starts_with(content, "MATLAB")) {
    return of_matlab_file(path);
  }
  if (const auto format = of_text(content, path)) {
    return format;
  }
  if (ends_with(path.string(), "_odometry.csv")) {
    return LogFormat::plaza;
  }
  const std::vector<std::string> names = names_in_archive(path);
  return contains(names, "DRS.txt") || contains(names, "LASER.txt") ? std::optional(LogFormat::acfr_ascii)
                                                                    : std::nullopt;
}

/// A serialised object of MRPT, which is linked into a program of its own.
void refuse_rawlog(const fs::path& path) {
  if (path.extension() != ".rawlog") return;
  throw core::InputError(
      path.string() +
      ": a rawlog of MRPT, which this program does not read. helixnav-rawlog turns it into a log that it "
      "does: helixnav-rawlog " +
      path.filename().string() + " " + path.stem().string() +
      ".jsonl; helixnav-slam navigates along it as it is. Both are built where MRPT is (docs/mrpt.md)");
}

core::Recording read_victoria_park(const AcfrLog& log, const RecordingSettings& settings) {
  return make_recording(log, settings.victoria_park);
}

core::Recording read_car_park(const fs::path& path, const RecordingSettings& settings) {
  return make_recording(read_car_park_mat(fs::is_directory(path) ? path / "data_set.mat" : path), settings.car_park);
}

Vehicle vehicle_of(const fs::path& log) {
  const fs::path file = vehicle_beside(log);
  return file.empty() ? Vehicle() : read_vehicle(file);
}

}  // namespace

std::string_view name_of(LogFormat format) {
  switch (format) {
    case LogFormat::acfr_ascii:
      return "acfr-ascii";
    case LogFormat::victoria_park_mat:
      return "victoria-park-mat";
    case LogFormat::car_park_mat:
      return "car-park-mat";
    case LogFormat::pose_landmark_text:
      return "pose-landmark-text";
    case LogFormat::g2o:
      return "g2o";
    case LogFormat::slsjf_mat:
      return "slsjf-mat";
    case LogFormat::dlr:
      return "dlr";
    case LogFormat::plaza:
      return "plaza";
    case LogFormat::own:
      return "own";
  }
  return "unknown";
}

LogFormat recognise(const fs::path& path) {
  if (!fs::exists(path)) {
    throw core::InputError(path.string() + ": expected a file or folder, found nothing there");
  }
  refuse_rawlog(path);
  if (is_mrclam(path)) {
    throw core::InputError(path.string() + ": a log of several robots (MRCLAM), which replay alone reads");
  }
  if (is_own_log(path)) return LogFormat::own;
  const std::optional<LogFormat> format = fs::is_directory(path) ? of_folder(path) : of_file(path);
  if (!format) {
    throw core::InputError(path.string() + ": no known log. Looked for " + looked_for);
  }
  return *format;
}

core::Recording read_recording(const fs::path& path, const RecordingSettings& settings) {
  switch (recognise(path)) {
    case LogFormat::acfr_ascii:
      return read_victoria_park(read_acfr_ascii(path), settings);
    case LogFormat::victoria_park_mat:
      return read_victoria_park(read_victoria_park_mat(path), settings);
    case LogFormat::car_park_mat:
      return read_car_park(path, settings);
    case LogFormat::pose_landmark_text:
      return read_pose_landmark_text(path, settings.noise_columns);
    case LogFormat::g2o:
      return recording_from_graph(read_g2o(path), path.stem().string());
    case LogFormat::slsjf_mat:
      return read_vicpark_clean(path);
    case LogFormat::dlr:
      return read_dlr(path, settings.dlr);
    case LogFormat::plaza:
      return read_plaza(path, settings.plaza);
    case LogFormat::own:
      return make_recording(read_own_log(path), settings.vehicle ? *settings.vehicle : vehicle_of(path));
  }
  throw core::InputError(path.string() + ": no known log");
}

}  // namespace helixnav::logs
