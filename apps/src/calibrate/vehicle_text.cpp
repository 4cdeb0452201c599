// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_text.hpp"

#include <array>
#include <cstdio>
#include <sstream>

namespace helixnav::apps {
namespace {

/// A line without what stands around it.
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

}  // namespace

std::string with_noise_scales(const logs::Vehicle& vehicle, const smoothing::NoiseScales& scales) {
  std::istringstream file(vehicle.text);
  std::string text, line;
  std::size_t sensor = 0;
  bool odometry = false;
  while (std::getline(file, line)) {
    const std::string words = trimmed(line);
    if (words.rfind("noise_scale", 0) == 0) continue;
    text += line + '\n';
    if (words.rfind("[odometry]", 0) == 0) {
      odometry = true;
      text += scale_line(vehicle.odometry.noise_scale, scales.odometry);
    } else if ((words.rfind("[[sensor]]", 0) == 0 || words.rfind("[sensor]", 0) == 0) &&
               sensor < vehicle.sensors.size()) {
      text += scale_line(vehicle.sensors[sensor++].noise_scale, scales.landmarks);
    }
  }
  if (!odometry) text += "\n[odometry]\n" + scale_line(1.0, scales.odometry);
  if (vehicle.sensors.empty()) text += "\n[[sensor]]\n" + scale_line(1.0, scales.landmarks);
  return text;
}

}  // namespace helixnav::apps
