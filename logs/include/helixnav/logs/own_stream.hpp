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

/// A line that was not used, or only in part.
struct RefusedLine {
  std::size_t line = 0;
  std::string key;  ///< the key that is wrong; empty if the line as a whole is
  std::string why;
};

/// What became known with a line.
struct StreamedEvents {
  core::Recording recording;         ///< events and labels, no truth
  std::vector<std::size_t> lines;    ///< [scan] the line it started with
  std::vector<RefusedLine> refused;  ///< nothing in them is used
  std::vector<std::string> remarks;  ///< each sentence appears once
};

/// JSON Lines of the user's own schema (docs/your_own_log.md), line by line, as events that are, number by number,
/// those that make_recording makes of the same lines in a file, as long as they are in order.
///
/// A scan is due once the odometry has reached its time, because the motion up to it is not known before. Detections of
/// one instant in one list are a whole scan; detections in rows of their own form a scan until a line of another kind
/// comes. If sensors have different delays, a scan also waits for lines as much later as the longest delay, since one taken
/// earlier may come until then. Late scans are woven in as long as no later one is due and they are at most late_s behind
/// the newest odometry (plus the sensors' delays); everything else out of order is refused. A line more than ten seconds and
/// a hundred mean intervals ahead of the newest waits for the next one, and is refused unless that is there, too. Truth
/// and fixes are skipped with a remark. Memory does not grow with the stream. Test: logs/own/own_stream_test.cpp.
class OwnStream {
 public:
  static constexpr double late_s = 1.0;
  static constexpr std::size_t longest_line = 1 << 20;  ///< bytes; a longer one is refused
  static constexpr std::size_t most_waiting = 1000;     ///< scans that wait for odometry; the oldest is refused then

  /// Throws core::InputError for a vehicle without a sensor, and for a sensor whose reach or view replay would have to
  /// estimate from the whole log. `by_identity`: identities are wanted as labels, with numbers and names treated alike;
  /// else labels mean nothing.
  explicit OwnStream(const Vehicle& vehicle, bool by_identity = false);
  ~OwnStream();
  OwnStream(const OwnStream&) = delete;
  OwnStream& operator=(const OwnStream&) = delete;

  /// One line without its line end; `number` is used in refusals. Never throws because of the line's content.
  StreamedEvents take(std::string_view line, std::size_t number);

  /// End of input: whatever is still waiting is due.
  StreamedEvents finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace helixnav::logs
