// SPDX-License-Identifier: BSD-3-Clause
#include "index/triangle_bins.hpp"

#include <cmath>

namespace helixnav::relocalize {

namespace {

constexpr double codes_a_bin = 16.0;

/// B bins a side make about B³/6 that the triangle inequality allows.
int side_count(std::size_t expected, float usual_m, float finest_m) {
  const int wanted = static_cast<int>(std::cbrt(6.0 * static_cast<double>(expected) / codes_a_bin));
  return std::max(4, std::min(wanted, static_cast<int>(usual_m / finest_m)));
}

}  // namespace

TriangleBins::TriangleBins(std::size_t expected, float usual_m, float finest_m)
    : expected_(std::max<std::size_t>(expected, 256)),
      bins_a_side_(side_count(expected_, usual_m, finest_m)),
      per_metre_(static_cast<float>(bins_a_side_ - 1) / usual_m) {
  std::size_t bins = 0;
  start_.resize(static_cast<std::size_t>(bins_a_side_ * bins_a_side_));
  for (int a = 0; a < bins_a_side_; ++a)
    for (int b = 0; b <= a; ++b) {
      start_[static_cast<std::size_t>(a * bins_a_side_ + b)] = static_cast<std::uint32_t>(bins);
      bins += static_cast<std::size_t>(a - least_third(a, b) + 1);
    }
  bins_.resize(bins);
}

TriangleBins::Bin& TriangleBins::bin_of(const Sides& sides_m) {
  const int a = place(sides_m[0]);
  const int b = place(sides_m[1]);
  return bins_[number(a, b, std::max(place(sides_m[2]), least_third(a, b)))];
}

void TriangleBins::insert(const Sides& sides_m, Code code) {
  Bin& bin = bin_of(sides_m);
  if (bin.count % line_codes == 0) {
    std::uint32_t line = free_line_;
    if (line == Line().next)
      line = lines_.push_back(Line());
    else
      free_line_ = lines_[line].next;
    lines_[line].next = bin.line;
    bin.line = line;
  }
  lines_[bin.line].code[bin.count % line_codes] = code;
  ++bin.count;
  ++size_;
}

void TriangleBins::erase(const Sides& sides_m, Code code) {
  Bin& bin = bin_of(sides_m);
  Line& first = lines_[bin.line];
  const std::uint32_t last = (bin.count - 1) % line_codes;
  const auto find_in = [&](Line& line, std::uint32_t count) {
    return std::find(line.code.begin(), line.code.begin() + count, code) - line.code.begin();
  };
  Line* line = &first;
  auto at = static_cast<std::uint32_t>(find_in(first, last + 1));
  if (at == last + 1) {
    do {
      line = &lines_[line->next];
      at = static_cast<std::uint32_t>(find_in(*line, line_codes));
    } while (at == line_codes);
  }
  line->code[at] = first.code[last];
  --bin.count;
  --size_;
  if (last > 0) return;
  const std::uint32_t empty = bin.line;
  bin.line = first.next;
  first.next = free_line_;
  free_line_ = empty;
}

std::size_t TriangleBins::memory_bytes() const {
  return lines_.memory_bytes() + bins_.capacity() * sizeof(Bin) + start_.capacity() * sizeof(std::uint32_t);
}

}  // namespace helixnav::relocalize
