// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "input_files.hpp"
#include "reading_times.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

constexpr const char* dead_reckoning_file = "DRS.txt";
constexpr const char* laser_file = "LASER.txt";
constexpr const char* gps_file = "GPS.txt";
constexpr const char* order_file = "Sensors_manager.txt";

std::vector<DeadReckoning> parse_dead_reckoning(TextCursor cursor) {
  std::vector<DeadReckoning> readings;
  ReadingTimes times;
  while (!cursor.at_end()) {
    DeadReckoning reading;
    reading.t_ns = times.next(cursor);
    reading.wheel_speed_mps = cursor.number("a speed [m/s]");
    reading.steering_rad = cursor.number("a steering angle [rad]");
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
    fix.position_m.y() = cursor.number("a northing [m]");
    fix.position_m.x() = cursor.number("an easting [m]");
    cursor.end_line("time, northing, easting");
    fixes.push_back(fix);
  }
  return fixes;
}

/// The text release has the ranges in metres with two decimals of what left the scanner as whole centimetres.
std::uint16_t centimetres(TextCursor& cursor) {
  const double range_m = cursor.number_between_in_stream(0.0, 655.35, "a range [m], 361 in each scan,");
  return static_cast<std::uint16_t>(std::lround(range_m * 100.0));
}

std::vector<SickScan> parse_laser(TextCursor cursor) {
  std::vector<SickScan> scans;
  ReadingTimes times;
  while (!cursor.at_end()) {
    SickScan& scan = scans.emplace_back();
    scan.t_ns = times.next(cursor);
    for (std::uint16_t& range_cm : scan.range_cm) {
      range_cm = centimetres(cursor);
    }
  }
  return scans;
}

/// Time of the reading `index` of a sensor; nothing when there is no such reading.
template <class Readings>
bool has_reading_at(const Readings& readings, std::int64_t index, core::Nanoseconds t_ns) {
  return index >= 0 && static_cast<std::size_t>(index) < readings.size() &&
         readings[static_cast<std::size_t>(index)].t_ns == t_ns;
}

bool has_reading_at(const AcfrLog& log, AcfrLog::Sensor sensor, std::int64_t index, core::Nanoseconds t_ns) {
  switch (sensor) {
    case AcfrLog::Sensor::gps:
      return has_reading_at(log.gps, index, t_ns);
    case AcfrLog::Sensor::dead_reckoning:
      return has_reading_at(log.dead_reckoning, index, t_ns);
    case AcfrLog::Sensor::laser:
      return has_reading_at(log.scans, index, t_ns);
  }
  return false;
}

/// Rows of time, sensor (1 GPS, 2 dead reckoning, 3 laser), index from 1 in that sensor's file.
std::vector<AcfrLog::Reading> parse_order(TextCursor cursor, const AcfrLog& log) {
  std::vector<AcfrLog::Reading> order;
  std::array<std::int64_t, 3> last_index{0, 0, 0};
  ReadingTimes times;
  while (!cursor.at_end()) {
    const core::Nanoseconds t_ns = times.next(cursor);
    const auto sensor = static_cast<std::size_t>(cursor.number_between(1, 3, "a sensor (1 GPS, 2 DRS, 3 laser)")) - 1;
    const std::int64_t index = cursor.integer("the row of a reading, from 1");
    if (index != last_index[sensor] + 1 || !has_reading_at(log, static_cast<AcfrLog::Sensor>(sensor), index - 1, t_ns)) {
      cursor.fail("expected row " + std::to_string(last_index[sensor] + 1) +
                  " of the sensor's file, at the time written there, found " + std::to_string(index));
    }
    last_index[sensor] = index;
    cursor.end_line("time, sensor, index");
    order.push_back({static_cast<AcfrLog::Sensor>(sensor), static_cast<std::size_t>(index) - 1});
  }
  return order;
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
  const auto cursor = [&](const char* name, TextCursor::Place place) {
    return TextCursor(texts.at(name), (folder_or_zip / name).string(), ' ', place);
  };
  AcfrLog log;
  log.name = folder_or_zip.stem().string();
  log.dead_reckoning = parse_dead_reckoning(cursor(dead_reckoning_file, TextCursor::Place::line));
  log.scans = parse_laser(cursor(laser_file, TextCursor::Place::byte));
  log.gps = parse_gps(cursor(gps_file, TextCursor::Place::line));
  log.order = parse_order(cursor(order_file, TextCursor::Place::line), log);
  require_readings(!log.dead_reckoning.empty(), (folder_or_zip / dead_reckoning_file).string(), "speed and steering");
  require_readings(!log.scans.empty(), (folder_or_zip / laser_file).string(), "scan");
  require_readings(!log.order.empty(), (folder_or_zip / order_file).string(), "reading");
  return log;
}

}  // namespace helixnav::logs
