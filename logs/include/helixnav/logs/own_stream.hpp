// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// A line that was not used, or not all of it.
struct RefusedLine {
  std::size_t line = 0;
  std::string key;  ///< that is wrong; empty where the line as a whole is
  std::string why;
};

/// What became known by a line.
struct StreamedEvents {
  core::Recording recording;         ///< events and labels, no truth
  std::vector<std::size_t> lines;    ///< [scan] the line it began with
  std::vector<RefusedLine> refused;  ///< nothing of them is used
  std::vector<std::string> remarks;  ///< each sentence comes once
};

/// JSON Lines of the user's own schema (docs/your_own_log.md) as they come, as events that are, number by number, those
/// that make_recording makes of the same lines in a file, as far as they stand in order.
///
/// A scan is due once the odometry has reached its time, because the motion up to it is not known before. Detections of
/// one instant in one list are a whole scan; rows of their own are a scan together until a line of something else comes.
/// Late scans are woven in as long as no later one is due and they are at most late_s behind the newest odometry (plus
/// what the sensors' delays are); everything else out of order is refused. A time more than an hour ahead of the newest is
/// refused unless the next one is there, too. Truth and fixes are passed over with a remark.
/// Memory does not grow with the stream. Test: logs/own/own_stream_test.cpp.
class OwnStream {
 public:
  static constexpr double late_s = 1.0;
  static constexpr std::size_t longest_line = 1 << 20;  ///< bytes; a longer one is refused
  static constexpr std::size_t most_waiting = 1000;     ///< scans that wait for odometry; the oldest is refused then

  /// Throws core::InputError for a vehicle without a sensor, and for a sensor of which replay would have to estimate reach
  /// or view from the whole log. `by_identity`: identities are wanted as labels, numbers or names alike for all; else
  /// labels mean nothing.
  explicit OwnStream(const Vehicle& vehicle, bool by_identity = false);
  ~OwnStream();
  OwnStream(const OwnStream&) = delete;
  OwnStream& operator=(const OwnStream&) = delete;

  /// One line without its end; `number` is for refusals. Throws nothing for what stands in it.
  StreamedEvents take(std::string_view line, std::size_t number);

  /// Nothing comes any more: what still waits is due.
  StreamedEvents finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace helixnav::logs
