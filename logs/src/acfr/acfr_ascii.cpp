// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <string>

#include "acfr_laser_text.hpp"
#include "acfr_limits.hpp"
#include "acfr_order.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "input_files.hpp"
#include "plausible.hpp"
#include "reading_times.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

constexpr const char* dead_reckoning_file = "DRS.txt";
constexpr const char* gps_file = "GPS.txt";
constexpr const char* order_file = "Sensors_manager.txt";

std::vector<DeadReckoning> parse_dead_reckoning(TextCursor cursor) {
  std::vector<DeadReckoning> readings;
  ReadingTimes times;
  while (!cursor.at_end()) {
    DeadReckoning reading;
    reading.t_ns = times.next(cursor);
    reading.wheel_speed_mps = cursor.number_between(-most_speed_mps, most_speed_mps, "a speed [m/s]");
    reading.steering_rad = cursor.number_between(-most_steering_rad, most_steering_rad, "a steering angle [rad]");
    cursor.end_line("time, speed, steering");
    readings.push_back(reading);
  }
  return readings;
}

std::vector<GpsFix> parse_gps(TextCursor cursor) {
  std::vector<GpsFix> fixes;
  ReadingTimes times;
  while (!cursor.at_end()) {
    GpsFix fix;
    fix.t_ns = times.next(cursor);
    fix.position_m.y() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "a northing [m]");
    fix.position_m.x() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "an easting [m]");
    cursor.end_line("time, northing, easting");
    fixes.push_back(fix);
  }
  return fixes;
}

void parse_order(TextCursor cursor, AcfrLog& log) {
  AcfrOrder order(log);
  ReadingTimes times;
  while (!cursor.at_end()) {
    const core::Nanoseconds t_ns = times.next(cursor);
    const std::int64_t sensor_code = cursor.integer("a sensor");
    const std::string objection = order.append(t_ns, sensor_code, cursor.integer("the row of a reading"));
    if (!objection.empty()) {
      cursor.fail(objection);
    }
    cursor.end_line("time, sensor, row");
  }
}

TextByName texts_of(const std::filesystem::path& folder_or_zip) {
  const std::vector<std::string> names = {dead_reckoning_file, laser_file, gps_file, order_file};
  if (!std::filesystem::is_directory(folder_or_zip)) {
    TextByName texts = read_archive(folder_or_zip, names);
    for (const std::string& name : names) {
      if (texts.count(name) == 0) {
        throw core::InputError(folder_or_zip.string() + ": expected " + name + " in this archive");
      }
    }
    return texts;
  }
  TextByName texts;
  for (const std::string& name : names) {
    texts[name] = read_file(folder_or_zip / name);
  }
  return texts;
}

void require_readings(bool there, const std::string& file, const char* what) {
  if (!there) {
    throw core::InputError(file + ": expected at least one " + what + ", found none");
  }
}

}  // namespace

AcfrLog read_acfr_ascii(const std::filesystem::path& folder_or_zip) {
  const TextByName texts = texts_of(folder_or_zip);
  const auto cursor = [&](const char* name) { return TextCursor(texts.at(name), (folder_or_zip / name).string()); };
  AcfrLog log;
  log.name = folder_or_zip.stem().string();
  log.dead_reckoning = parse_dead_reckoning(cursor(dead_reckoning_file));
  log.scans = parse_laser_text(texts.at(laser_file), (folder_or_zip / laser_file).string());
  log.gps = parse_gps(cursor(gps_file));
  parse_order(cursor(order_file), log);
  require_readings(!log.dead_reckoning.empty(), (folder_or_zip / dead_reckoning_file).string(), "speed and steering");
  require_readings(!log.scans.empty(), (folder_or_zip / laser_file).string(), "scan");
  require_readings(!log.order.empty(), (folder_or_zip / order_file).string(), "reading");
  return log;
}

}  // namespace helixnav::logs
