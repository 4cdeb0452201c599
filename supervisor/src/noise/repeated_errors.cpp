// SPDX-License-Identifier: BSD-3-Clause
#include "noise/repeated_errors.hpp"

#include <iterator>

namespace helixnav::supervisor {

void RepeatedErrors::next_scan() {
  constexpr long passed_after = 20;  // scans without a look
  ++scan_;
  sums_.fade();
  for (auto run = runs_.begin(); run != runs_.end();)
    run = scan_ - run->second.scan > passed_after ? runs_.erase(run) : std::next(run);
}

void RepeatedErrors::add(core::LandmarkId id, const Eigen::Vector2d& error) {
  constexpr int looks = 8;
  Run& run = runs_[id];
  run.scan = scan_;
  run.sum += error;
  if (++run.looks < looks) return;
  sums_.add(run.sum.squaredNorm() / looks, 1.0);
  run = Run{};
  run.scan = scan_;
}

}  // namespace helixnav::supervisor
