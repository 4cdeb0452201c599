// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace helixnav::apps {

/// A line on stderr that shows the progress of a run. Silent unless stderr is a terminal and `quiet` is false; redrawn
/// at most once per percent, so that it costs nothing.
class ProgressBar {
 public:
  ProgressBar(std::string what, std::size_t total, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance_to(std::size_t done);

 private:
  void draw(int percent) const;

  std::string what_;
  std::size_t total_;
  bool visible_;
  int percent_ = -1;
};

}  // namespace helixnav::apps
