// SPDX-License-Identifier: BSD-3-Clause
#include "slipped_scans.hpp"

#include <algorithm>
#include <variant>

namespace helixnav::apps {

std::vector<std::size_t> slipped_scans(const std::vector<core::StepReport>& steps) {
  std::vector<std::size_t> scans;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto& decisions = steps[k].decisions;
    const bool slipped = std::any_of(decisions.begin(), decisions.end(), [](const core::Decision& decision) {
      return std::holds_alternative<core::SlipDecision>(decision);
    });
    if (slipped) scans.push_back(k);
  }
  return scans;
}

std::size_t count_slips(const std::vector<std::size_t>& scans) {
  constexpr std::size_t most_apart = 3;
  std::size_t slips = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) slips += i == 0 || scans[i] - scans[i - 1] > most_apart ? 1 : 0;
  return slips;
}

void loosen_odometry(const std::vector<std::size_t>& scans, core::Recording& recording) {
  constexpr double sigma_m = 100.0, sigma_rad = 3.0;
  const Eigen::Matrix3d loose = Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2().asDiagonal();
  auto next = scans.begin();
  std::size_t scan = 0;  // the one that the odometry leads to
  for (core::Event& event : recording.events) {
    if (std::holds_alternative<core::Scan>(event)) ++scan;
    while (next != scans.end() && *next < scan) ++next;
    auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry != nullptr && next != scans.end() && *next == scan) odometry->covariance += loose;
  }
}

}  // namespace helixnav::apps
