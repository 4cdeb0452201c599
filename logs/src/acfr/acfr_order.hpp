// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "helixnav/logs/acfr_log.hpp"

namespace helixnav::logs {

/// Fills log.order from the rows of an event table: time, sensor (1 GPS, 2 dead reckoning, 3 laser), and the row,
/// counted from 1, of the reading in that sensor's table. The other fields of the log are complete before this.
class AcfrOrder {
 public:
  explicit AcfrOrder(AcfrLog& log) : log_(log) {}

  /// Empty when the row fits: the next reading of its sensor, at the time given in the sensor's table; else what was
  /// expected.
  std::string append(core::Nanoseconds t_ns, std::int64_t sensor_code, std::int64_t row);

 private:
  bool has_reading_at(AcfrLog::Sensor sensor, std::size_t index, core::Nanoseconds t_ns) const;

  AcfrLog& log_;
  std::array<std::size_t, 3> taken_{};
};

/// Fills log.order by time if no table gives it; at the same time dead reckoning before GPS before laser.
void order_by_time(AcfrLog& log);

}  // namespace helixnav::logs
