// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace helixnav::fastslam {

/// From how many particles of some drive ago the current particles descend. A mark is set every eighth of that drive, and
/// every particle carries the number of its ancestor at each mark that is kept. Test: apps/fastslam_test.cpp (the drive is the
/// same with and without).
class Genealogy {
 public:
  Genealogy(std::size_t particles, double back_m) : back_m_(back_m) { set_mark(particles); }

  /// Particle k comes from parents[k] of the previous set.
  void descend(const std::vector<std::uint32_t>& parents);

  /// The robot has driven on; `particles`: how many there are.
  void drive(double length_m, std::size_t particles);

  /// Distinct ancestors at the latest mark at least `back_m` ago, else at the first.
  std::size_t distinct_ancestors() const;

 private:
  struct Mark {
    double at_m = 0.0;
    std::vector<std::uint32_t> ancestor;  ///< [current particle]
  };
  void set_mark(std::size_t particles);

  double back_m_, driven_m_ = 0.0;
  std::deque<Mark> marks_;  ///< oldest first
};

}  // namespace helixnav::fastslam
