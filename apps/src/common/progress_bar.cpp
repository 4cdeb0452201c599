// SPDX-License-Identifier: BSD-3-Clause
#include "progress_bar.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace helixnav::apps {

ProgressBar::ProgressBar(std::string what, std::size_t total, bool quiet)
    : what_(std::move(what)), total_(total), visible_(!quiet && total > 0 && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (visible_ && percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void ProgressBar::advance_to(std::size_t done) {
  if (!visible_) return;
  const int percent = static_cast<int>(100 * done / total_);
  if (percent == percent_) return;
  percent_ = percent;
  draw(percent);
}

void ProgressBar::draw(int percent) const {
  constexpr int width = 40;
  std::string bar(width, '.');
  bar.replace(0, static_cast<std::size_t>(width * percent / 100), static_cast<std::size_t>(width * percent / 100), '#');
  std::fprintf(stderr, "\r%s [%s] %3d %%", what_.c_str(), bar.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace helixnav::apps
