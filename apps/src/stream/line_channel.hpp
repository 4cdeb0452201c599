// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "helixnav/logs/own_stream.hpp"

namespace helixnav::apps {

/// Where lines come from and answers go to: standard input and output, or one client after another on a local socket.
/// Reading and writing block, but return at once when the program is interrupted. Test: apps/stream_test.cpp.
class LineChannel {
 public:
  /// "" for the standard streams, "unix:PATH" or "tcp:PORT" on 127.0.0.1 (0: a free one). InputError for an address that
  /// cannot be listened on.
  explicit LineChannel(const std::string& address);
  ~LineChannel();
  LineChannel(const LineChannel&) = delete;
  LineChannel& operator=(const LineChannel&) = delete;

  /// Where clients find it; empty for the standard streams.
  const std::string& address() const { return address_; }

  /// Waits for the next line, without its newline; the last line of an input or client may have none. A line longer
  /// than longest_line is cut to its beginning, one byte more than that. False at the end of input, or when
  /// interrupted.
  bool next(std::string& line);

  /// Number of the last line, from 1, in its input or of its client.
  std::size_t line_number() const { return number_; }

  /// Writes a line and its newline; waits for slow readers. Nothing is written to a client that is gone. False if
  /// nobody reads the standard output any more.
  bool send(std::string line);

  /// The reason in words, after send returned false.
  std::string why_nobody_reads() const;

  static constexpr std::size_t longest_line = logs::OwnStream::longest_line;

 private:
  bool wait_for(int descriptor, short what);
  bool accept_client();
  void drop_client();
  bool take_line(std::string& line);
  void fill();

  std::string address_;
  std::string path_;  ///< of a Unix socket, to be removed
  int listening_ = -1;
  int in_ = -1, out_ = -1;
  std::string buffer_;
  std::size_t begin_ = 0, searched_ = 0;
  bool skipping_ = false;  ///< the rest of a line that is too long
  bool ended_ = false;     ///< this input
  std::size_t number_ = 0;
  int write_error_ = 0;
};

}  // namespace helixnav::apps
