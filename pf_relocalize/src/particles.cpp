// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/particles.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace helixnav::pf_relocalize {
namespace {

constexpr std::uint32_t levels = 10;  // bits a coordinate

/// Position of a coordinate in its extent, in 2^levels steps.
std::vector<std::uint32_t> steps_of(const std::vector<double>& column) {
  const auto [low, high] = std::minmax_element(column.begin(), column.end());
  const double scale = ((1U << levels) - 1U) / std::max(*high - *low, 1e-9);
  std::vector<std::uint32_t> steps;
  for (const double value : column) steps.push_back(static_cast<std::uint32_t>((value - *low) * scale));
  return steps;
}

/// The bits of three coordinates interleaved: the Morton curve.
std::uint32_t interleaved(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t key = 0;
  for (std::uint32_t bit = levels; bit-- > 0;) {
    key = (key << 3) | (((a >> bit) & 1U) << 2) | (((b >> bit) & 1U) << 1) | ((c >> bit) & 1U);
  }
  return key;
}

void permute(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& order, std::vector<double>& column) {
  const std::vector<double> before = column;
  for (std::size_t i = 0; i < order.size(); ++i) column[i] = before[order[i].second];
}

}  // namespace

void order_by_place(Particles& particles) {
  if (particles.size() == 0) return;
  const std::vector<std::uint32_t> heading = steps_of(particles.heading_rad), x = steps_of(particles.x_m),
                                   y = steps_of(particles.y_m);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    order.emplace_back(interleaved(heading[i], x[i], y[i]), static_cast<std::uint32_t>(i));
  }
  std::sort(order.begin(), order.end());
  for (auto* column : {&particles.x_m, &particles.y_m, &particles.heading_rad, &particles.log_weight}) {
    permute(order, *column);
  }
  for (std::vector<double>& column : particles.latent) permute(order, column);
}

}  // namespace helixnav::pf_relocalize
