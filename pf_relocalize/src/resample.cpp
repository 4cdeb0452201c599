// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/resample.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::pf_relocalize {

void take_parents(const Particles& particles, const std::vector<std::uint32_t>& parents, Particles& out) {
  out.latent.resize(particles.latent.size());
  out.resize(parents.size());
  const double log_weight = -std::log(static_cast<double>(parents.size()));
  for (std::size_t k = 0; k < parents.size(); ++k) {
    out.x_m[k] = particles.x_m[parents[k]];
    out.y_m[k] = particles.y_m[parents[k]];
    out.heading_rad[k] = particles.heading_rad[parents[k]];
    out.log_weight[k] = log_weight;
    for (std::size_t q = 0; q < particles.latent.size(); ++q) out.latent[q][k] = particles.latent[q][parents[k]];
  }
}

std::size_t kld_sample_size(std::size_t bins, double error) {
  if (bins < 2) return 1;
  constexpr double z99 = 2.3263478740408408;
  const double k = static_cast<double>(bins - 1), a = 2.0 / (9.0 * k);
  return static_cast<std::size_t>(std::ceil(k / (2.0 * error) * std::pow(1.0 - a + std::sqrt(a) * z99, 3)));
}

std::size_t occupied_bins(const Particles& particles, const std::vector<std::uint32_t>& indices, double edge_m,
                          double edge_rad, std::vector<std::uint64_t>& keys) {
  const auto bin = [](double value, double edge) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / edge))) & 0x1fffffU;
  };
  keys.clear();
  for (const std::uint32_t i : indices) {
    const std::uint64_t key = (bin(particles.x_m[i], edge_m) << 42) | (bin(particles.y_m[i], edge_m) << 21) |
                              bin(particles.heading_rad[i], edge_rad);
    if (keys.empty() || keys.back() != key) keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

}  // namespace helixnav::pf_relocalize
