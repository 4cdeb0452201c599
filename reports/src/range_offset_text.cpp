// SPDX-License-Identifier: BSD-3-Clause
#include "range_offset_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace helixnav::reports {

std::string range_offset_text(const runs::Run& run) {
  double missing_m = 0.0, sigma_m = 0.0;
  for (const auto& [key, value] : run.numbers) {
    if (key == "range_offset.missing_m") missing_m = value;
    if (key == "range_offset.sigma_m") sigma_m = value;
  }
  if (missing_m == 0.0) return {};
  std::array<char, 300> text{};
  std::snprintf(
      text.data(), text.size(),
      "ranges seem to be %s by %.3f +- %.3f m at least, in every scan alike, which is no noise: the path is less "
      "certain than it seems. 'helixnav calibrate LOG' finds range_offset_m",
      missing_m > 0.0 ? "short" : "long", std::abs(missing_m), 1.96 * sigma_m);
  return text.data();
}

}  // namespace helixnav::reports
