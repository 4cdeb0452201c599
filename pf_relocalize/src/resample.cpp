// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/resample.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/errors.hpp"

namespace helixnav::pf_relocalize {

double normalise(Particles& particles) {
  double largest = -HUGE_VAL;
  for (const double lw : particles.log_weight) {
    if (std::isnan(lw)) throw core::NumericalError("particle filter: a weight is NaN");
    largest = std::max(largest, lw);
  }
  if (!std::isfinite(largest)) throw core::NumericalError("particle filter: no particle has a finite weight");
  double sum = 0.0;
  for (const double lw : particles.log_weight) sum += std::exp(lw - largest);
  const double log_sum = largest + std::log(sum);
  for (double& lw : particles.log_weight) lw -= log_sum;
  return log_sum;
}

double effective_sample_size(const Particles& particles) {
  double squares = 0.0;
  for (const double lw : particles.log_weight) squares += std::exp(2.0 * lw);
  return 1.0 / squares;
}

void systematic_parents(const Particles& particles, std::size_t m, double offset, std::vector<std::uint32_t>& parents) {
  parents.clear();
  double reached = 0.0;
  std::uint32_t heaviest = 0;
  for (std::size_t i = 0; i < particles.size() && parents.size() < m; ++i) {
    reached += std::exp(particles.log_weight[i]) * static_cast<double>(m);
    if (particles.log_weight[i] > particles.log_weight[heaviest]) heaviest = static_cast<std::uint32_t>(i);
    while (static_cast<double>(parents.size()) + offset < reached && parents.size() < m) {
      parents.push_back(static_cast<std::uint32_t>(i));
    }
  }
  while (parents.size() < m) parents.push_back(parents.empty() ? heaviest : parents.back());  // round-off at the end
}

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
