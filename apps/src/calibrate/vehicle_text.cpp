// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

namespace helixnav::apps {
namespace {

/// A line without surrounding blanks.
std::string trimmed(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  const std::size_t end = line.find_last_not_of(" \t\r");
  return line.substr(begin, end - begin + 1);
}

std::string scale_line(double assumed, const smoothing::NoiseScale& scale) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "noise_scale = %.4g  # calibrated; 95 %%: %.4g to %.4g\n",
                assumed * scale.factor, assumed * scale.low_95, assumed * scale.high_95);
  return text.data();
}

struct NewLine {
  std::string stem;  ///< of the key that it replaces, in whatever unit
  std::string text;
};

std::string constant_line(const ConstantFound& found, double value) {
  std::array<char, 200> text{};
  const double unit = found.constant.unit, half = 1.96 * found.kept_sigma / unit;
  const int decimals = half > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 9) : 6;
  std::snprintf(text.data(), text.size(), "%s = %.6g  # calibrated; 95 %%: %.*f to %.*f\n", found.constant.key.c_str(),
                value / unit, decimals, value / unit - half, decimals, value / unit + half);
  return text.data();
}

double told_delay_s(const logs::Vehicle& vehicle, int sensor) {
  const auto i = static_cast<std::size_t>(sensor);
  return i < vehicle.sensors.size() ? vehicle.sensors[i].delay_s : 0.0;
}

/// What goes into [odometry] (−1) or a [[sensor]].
std::vector<NewLine> lines_of(const logs::Vehicle& vehicle, const Calibration& calibration, int section) {
  std::vector<NewLine> lines;
  const auto i = static_cast<std::size_t>(section);
  const double sensor_scale = i < vehicle.sensors.size() ? vehicle.sensors[i].noise_scale : 1.0;
  lines.push_back({"noise_scale", section < 0 ? scale_line(vehicle.odometry.noise_scale, calibration.scales.odometry)
                                              : scale_line(sensor_scale, calibration.scales.landmarks)});
  for (const ConstantFound& found : calibration.constants) {
    const bool every = section >= 0 && found.constant.sensor == VehicleConstant::every_sensor;
    if (!found.kept() || !(every || found.constant.sensor == section)) continue;
    const double value = every ? told_delay_s(vehicle, section) + found.kept_value - found.told : found.kept_value;
    lines.push_back({found.constant.stem, constant_line(found, value)});
  }
  return lines;
}

/// Whether a line gives the key, in whatever unit.
bool gives(const std::string& words, const std::string& stem) {
  if (words.rfind(stem, 0) != 0) return false;
  const std::string rest = trimmed(words.substr(stem.size(), words.find('=') - stem.size()));
  return words.find('=') != std::string::npos &&
         (rest.empty() || rest == "_deg" || rest == "_rad" || rest == "_deg_per_s" || rest == "_rad_per_s");
}

std::string joined(const std::vector<NewLine>& lines) {
  std::string text;
  for (const NewLine& line : lines) text += line.text;
  return text;
}

}  // namespace

std::string calibrated_text(const logs::Vehicle& vehicle, const Calibration& calibration) {
  std::istringstream file(vehicle.text);
  std::string text, line;
  int sensor = -1;
  bool odometry = false;
  std::vector<NewLine> lines;  // of the section that the line is in
  while (std::getline(file, line)) {
    const std::string words = trimmed(line);
    const bool replaced =
        std::any_of(lines.begin(), lines.end(), [&words](const NewLine& by) { return gives(words, by.stem); });
    if (replaced) continue;
    text += line + '\n';
    if (words.empty() || words.front() != '[') continue;
    lines.clear();
    if (words.rfind("[odometry]", 0) == 0) {
      odometry = true;
      lines = lines_of(vehicle, calibration, -1);
    } else if (words.rfind("[[sensor]]", 0) == 0 || words.rfind("[sensor]", 0) == 0) {
      lines = lines_of(vehicle, calibration, ++sensor);
    }
    text += joined(lines);
  }
  if (!odometry) text += "\n[odometry]\n" + joined(lines_of(vehicle, calibration, -1));
  if (vehicle.sensors.empty()) text += "\n[[sensor]]\n" + joined(lines_of(vehicle, calibration, 0));
  return text;
}

}  // namespace helixnav::apps
