// SPDX-License-Identifier: BSD-3-Clause
#include "systematic_errors_text.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>
#include <variant>

#include "degrees.hpp"
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

const char* side(double angle) { return angle > 0.0 ? "left" : "right"; }

std::string turning_text(double turn_rad, const char* per) {
  return text_of("odometry turns %.2g deg per %s too far to the %s", std::abs(in_degrees(turn_rad)), per,
                 side(turn_rad));
}

struct TakenOut {
  core::SystematicDecision last, all;  ///< `all`: of each error the last that was not 0
  std::size_t first_step = 0, last_step = 0;
  bool any = false, put_back = false;
};

TakenOut taken_out_in(const runs::Run& run) {
  TakenOut taken;
  const auto keep = [&](double now, double& all) {
    taken.put_back = taken.put_back || (now == 0.0 && all != 0.0);
    if (now != 0.0) all = now;
  };
  for (std::size_t step = 0; step < run.steps.size(); ++step) {
    for (const core::Decision& decision : run.steps[step].decisions) {
      const auto* d = std::get_if<core::SystematicDecision>(&decision);
      if (d == nullptr) continue;
      if (!taken.any) taken.first_step = step;
      taken.any = true;
      taken.last = *d;
      taken.last_step = step;
      keep(d->too_long, taken.all.too_long);
      keep(d->turn_rad_per_s, taken.all.turn_rad_per_s);
      keep(d->turn_rad_per_m, taken.all.turn_rad_per_m);
      keep(d->heading_rad, taken.all.heading_rad);
      keep(d->short_m, taken.all.short_m);
    }
  }
  return taken;
}

/// Empty if nothing was taken out while driving.
std::string taken_out_text(const runs::Run& run) {
  const TakenOut taken = taken_out_in(run);
  if (!taken.any) return {};
  if (taken.put_back) {
    return "odometry and detections contradict each other for long stretches, but not in the same way throughout: " +
           systematic_errors_text(taken.all) + " were taken out from step " + std::to_string(taken.first_step) +
           " on, and what had changed was put back until step " + std::to_string(taken.last_step) +
           ". An offset of steering or gyro that changes slowly is not corrected, and the path is less certain than "
           "stated";
  }
  return "odometry and detections contradict each other throughout: " + systematic_errors_text(taken.last) +
         "; taken out while driving, which was possible from step " + std::to_string(taken.first_step) +
         " on. 'helixnav calibrate LOG' estimates what to write into vehicle.toml";
}

std::string sensor_text(const runs::Run& run, const std::string& sensor) {
  const auto number = [&](const char* key) { return number_of(run, ("sensors_apart." + sensor + key).c_str()); };
  return text_of("the sensor at x %.2f, y %.2f, heading %.4g deg", number(".x_m"), number(".y_m"),
                 in_degrees(number(".heading_rad")));
}

/// Empty unless two sensors contradict each other.
std::string sensors_apart_text(const runs::Run& run) {
  const double farther_m = number_of(run, "sensors_apart.farther_m");
  const double left_rad = number_of(run, "sensors_apart.left_rad");
  if (farther_m == 0.0 && left_rad == 0.0) return {};
  return "two sensors contradict each other throughout, which is not noise: " + sensor_text(run, "one") +
         text_of(" sees landmarks %.3f +- %.3f m %s and %.2g +- %.2g deg farther to the %s than ", std::abs(farther_m),
                 1.96 * number_of(run, "sensors_apart.farther_sigma_m"), farther_m > 0.0 ? "farther away" : "nearer",
                 std::abs(in_degrees(left_rad)), 1.96 * in_degrees(number_of(run, "sensors_apart.left_sigma_rad")),
                 side(left_rad)) +
         sensor_text(run, "other") +
         ", after the map has met both half-way. Mounting, range_offset_m or delay_s of one of them is not what the "
         "vehicle file "
         "says, and the path is less certain than stated. 'helixnav calibrate LOG' estimates mounting and range "
         "offset of each, but one delay for all";
}

}  // namespace

std::string systematic_errors_text(const core::SystematicDecision& d) {
  std::vector<std::string> parts;
  if (d.too_long != 0.0) {
    parts.push_back(text_of("odometry distances are %.2g %% too %s (or ranges too %s)", 100.0 * std::abs(d.too_long),
                            d.too_long > 0.0 ? "long" : "short", d.too_long > 0.0 ? "short" : "long"));
  }
  if (d.turn_rad_per_s != 0.0) parts.push_back(turning_text(d.turn_rad_per_s, "second"));
  if (d.turn_rad_per_m != 0.0) parts.push_back(turning_text(d.turn_rad_per_m, "metre"));
  if (d.heading_rad != 0.0) {
    parts.push_back(text_of("sensors point %.2g deg farther to the %s than heading_deg says",
                            std::abs(in_degrees(d.heading_rad)), side(d.heading_rad)));
  }
  if (d.short_m != 0.0) {
    parts.push_back(text_of("ranges are %.3f m too %s", std::abs(d.short_m), d.short_m > 0.0 ? "short" : "long"));
  }
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::vector<std::string> systematic_errors_texts(const runs::Run& run) {
  std::vector<std::string> texts;
  if (std::string text = taken_out_text(run); !text.empty()) texts.push_back(std::move(text));
  if (std::string text = sensors_apart_text(run); !text.empty()) texts.push_back(std::move(text));
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
