// SPDX-License-Identifier: BSD-3-Clause
#include "systematic_errors_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "helixnav/core/angle.hpp"

namespace helixnav::reports {
namespace {

/// 0 where the run does not say it.
double number_of(const runs::Run& run, const char* key) {
  for (const auto& [name, value] : run.numbers) {
    if (name == key) return value;
  }
  return 0.0;
}

template <class... Values>
std::string text_of(const char* format, Values... values) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

std::vector<std::string> systematic_errors_texts(const runs::Run& run) {
  std::vector<std::string> texts;
  const double missing_m = number_of(run, "range_offset.missing_m");
  if (missing_m != 0.0) {
    texts.push_back(text_of(
        "ranges seem to be too %s by at least %.3f +- %.3f m in every scan, which is not noise: the path is less "
        "certain than stated. 'helixnav calibrate LOG' estimates range_offset_m",
        missing_m > 0.0 ? "short" : "long", std::abs(missing_m), 1.96 * number_of(run, "range_offset.sigma_m")));
  }
  const double too_long = number_of(run, "odometry.too_long");
  if (too_long != 0.0) {
    texts.push_back(text_of(
        "judging by the detections, odometry distances are about %.1f %% too %s throughout (or ranges too %s), which "
        "is not noise: the map's scale is in doubt. 'helixnav calibrate LOG' estimates scale",
        100.0 * std::abs(too_long), too_long > 0.0 ? "long" : "short", too_long > 0.0 ? "short" : "long"));
  }
  const double sideways_rad = number_of(run, "odometry.sideways_rad");
  if (sideways_rad != 0.0) {
    texts.push_back(
        text_of("judging by the detections, the vehicle moves at least %.1f deg to the %s of its odometry throughout, "
                "as if the sensor looked that much farther to the %s than heading_deg says: the path is less certain "
                "than stated. "
                "'helixnav calibrate LOG' estimates heading_deg",
                std::abs(sideways_rad) * 180.0 / core::pi, sideways_rad > 0.0 ? "left" : "right",
                sideways_rad > 0.0 ? "right" : "left"));
  }
  return texts;
}

}  // namespace helixnav::reports
