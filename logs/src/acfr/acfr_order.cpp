// SPDX-License-Identifier: BSD-3-Clause
#include "acfr_order.hpp"

#include <algorithm>
#include <utility>

namespace helixnav::logs {
namespace {

template <class Readings>
bool matches(const Readings& readings, std::size_t index, core::Nanoseconds t_ns) {
  return index < readings.size() && readings[index].t_ns == t_ns;
}

}  // namespace

bool AcfrOrder::has_reading_at(AcfrLog::Sensor sensor, std::size_t index, core::Nanoseconds t_ns) const {
  switch (sensor) {
    case AcfrLog::Sensor::gps:
      return matches(log_.gps, index, t_ns);
    case AcfrLog::Sensor::dead_reckoning:
      return matches(log_.dead_reckoning, index, t_ns);
    case AcfrLog::Sensor::laser:
      return matches(log_.scans, index, t_ns);
  }
  return false;
}

std::string AcfrOrder::append(core::Nanoseconds t_ns, std::int64_t sensor_code, std::int64_t row) {
  if (sensor_code < 1 || sensor_code > 3) {
    return "expected a sensor 1 (GPS), 2 (dead reckoning) or 3 (laser), found " + std::to_string(sensor_code);
  }
  std::size_t& taken = taken_[static_cast<std::size_t>(sensor_code) - 1];
  const auto sensor = static_cast<AcfrLog::Sensor>(sensor_code - 1);
  if (row != static_cast<std::int64_t>(taken) + 1 || !has_reading_at(sensor, taken, t_ns)) {
    return "expected row " + std::to_string(taken + 1) + " of sensor " + std::to_string(sensor_code) +
           " at the time that its table has, found row " + std::to_string(row) + " at " +
           std::to_string(core::seconds(t_ns)) + " s";
  }
  log_.order.push_back({sensor, taken});
  ++taken;
  return {};
}

void order_by_time(AcfrLog& log) {
  std::vector<std::pair<core::Nanoseconds, AcfrLog::Reading>> readings;
  const auto add = [&](AcfrLog::Sensor sensor, const auto& of_sensor) {
    for (std::size_t i = 0; i < of_sensor.size(); ++i) {
      readings.push_back({of_sensor[i].t_ns, {sensor, i}});
    }
  };
  add(AcfrLog::Sensor::dead_reckoning, log.dead_reckoning);
  add(AcfrLog::Sensor::gps, log.gps);
  add(AcfrLog::Sensor::laser, log.scans);
  std::stable_sort(readings.begin(), readings.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  log.order.clear();
  for (const auto& [t_ns, reading] : readings) {
    log.order.push_back(reading);
  }
}

}  // namespace helixnav::logs
