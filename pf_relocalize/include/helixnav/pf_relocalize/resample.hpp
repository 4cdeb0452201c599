// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/pf_relocalize/particles.hpp"

namespace helixnav::pf_relocalize {

/// Copies the particles named by `parents` into `out`, weights equal and normalised.
void take_parents(const Particles& particles, const std::vector<std::uint32_t>& parents, Particles& out);

/// How many particles a cloud needs: the number n at which, with 99 % probability, the Kullback–Leibler divergence of
/// the sampled from the true distribution over bins stays below `error` when `bins` of them are occupied (Fox 2003,
/// Wilson–Hilferty form of the χ² quantile). Test: pf_relocalize/resample_test.cpp (against core::chi2_quantile).
std::size_t kld_sample_size(std::size_t bins, double error);

/// Number of different bins (edges [m] and [rad]) that the particles named by `indices` occupy. `keys` is working
/// memory. Cost O(n log n).
std::size_t occupied_bins(const Particles& particles, const std::vector<std::uint32_t>& indices, double edge_m,
                          double edge_rad, std::vector<std::uint64_t>& keys);

}  // namespace helixnav::pf_relocalize
