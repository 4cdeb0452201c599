// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "index/paged.hpp"
#include "index/triangle.hpp"

namespace helixnav::relocalize {

/// Codes of triangles in bins of their three sides; only bins that the triangle inequality allows exist. A bin is a list of
/// lines of seven codes. Which bins there are is a matter of speed: readers compare the sides themselves.
class TriangleBins {
 public:
  /// Bins for `expected` triangles, of which one in twenty has a longest side above `usual_m`; none finer than `finest_m`.
  TriangleBins(std::size_t expected, float usual_m, float finest_m);

  void insert(const Sides& sides_m, Code code);
  void erase(const Sides& sides_m, Code code);

  std::size_t size() const { return size_; }
  bool outgrown() const { return 2 * size_ > 3 * expected_; }
  std::size_t memory_bytes() const;

  /// Calls visit(codes, count) until all bins that may hold sides within tolerance_m of these were visited.
  template <class Visit>
  void near(const Sides& sides_m, float tolerance_m, Visit&& visit) const {
    const auto low = [&](std::size_t k) { return place(sides_m[k] - tolerance_m); };
    const auto high = [&](std::size_t k) { return place(sides_m[k] + tolerance_m); };
    for (int a = low(0); a <= high(0); ++a)
      for (int b = low(1); b <= std::min(a, high(1)); ++b) {
        const int first = std::max(low(2), least_third(a, b));
        for (int c = first; c <= std::min(a, high(2)); ++c) visit_bin(bins_[number(a, b, c)], visit);
      }
  }

  template <class Visit>
  void all(Visit&& visit) const {
    for (const Bin& bin : bins_) visit_bin(bin, visit);
  }

 private:
  static constexpr std::uint32_t line_codes = 7;
  struct Line {
    std::array<Code, line_codes> code{};
    std::uint32_t next = 0xFFFFFFFFU;
  };
  struct Bin {
    std::uint32_t line = 0xFFFFFFFFU;  ///< the first one, the only one that may have room
    std::uint32_t count = 0;
  };

  int place(float side_m) const { return std::clamp(static_cast<int>(side_m * per_metre_), 0, bins_a_side_ - 1); }
  static int least_third(int a, int b) { return std::max(0, a - b - 1); }
  std::size_t number(int a, int b, int c) const {
    return start_[static_cast<std::size_t>(a * bins_a_side_ + b)] + static_cast<std::size_t>(c - least_third(a, b));
  }
  Bin& bin_of(const Sides& sides_m);

  template <class Visit>
  void visit_bin(const Bin& bin, Visit& visit) const {
    std::uint32_t left = bin.count;
    for (std::uint32_t line = bin.line; left > 0; line = lines_[line].next) {
      const std::uint32_t here = (left - 1) % line_codes + 1;
      visit(lines_[line].code.data(), here);
      left -= here;
    }
  }

  std::size_t expected_;
  std::size_t size_ = 0;
  int bins_a_side_;
  float per_metre_;
  std::vector<std::uint32_t> start_;  ///< [a, b] number of the first bin of that row
  std::vector<Bin> bins_;
  Paged<Line, 10> lines_;
  std::uint32_t free_line_ = 0xFFFFFFFFU;
};

}  // namespace helixnav::relocalize
