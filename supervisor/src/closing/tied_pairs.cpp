// SPDX-License-Identifier: BSD-3-Clause
#include "closing/tied_pairs.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "association/median.hpp"
#include "closing/relative_variance.hpp"

namespace helixnav::supervisor {
namespace {

using pf_relocalize::ConstellationPair;

/// Median distance of the branch landmarks to the nearest other one.
double spacing_m(const cekf::CompressedEkf& filter, const std::vector<ConstellationPair>& pairs) {
  std::vector<double> nearest_m;
  for (const ConstellationPair& one : pairs) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const ConstellationPair& other : pairs) {
      if (other.branch == one.branch) continue;
      least_m = std::min(least_m, (filter.landmark_mean(other.branch) - filter.landmark_mean(one.branch)).norm());
    }
    nearest_m.push_back(least_m);
  }
  return median(std::move(nearest_m));
}

/// [pair] a number that it shares with the other pairs of its piece.
std::vector<std::size_t> pieces_of(const cekf::CompressedEkf& filter, const std::vector<ConstellationPair>& pairs) {
  std::vector<core::LandmarkId> ids;
  for (const ConstellationPair& pair : pairs) ids.push_back(pair.old_landmark);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const core::JointGaussian joint = filter.joint(ids);
  const auto row_of = [&](const ConstellationPair& pair) {
    return 3 + 2 * (std::lower_bound(ids.begin(), ids.end(), pair.old_landmark) - ids.begin());
  };
  const double half_m = 0.5 * spacing_m(filter, pairs);
  std::vector<std::size_t> piece(pairs.size());
  std::iota(piece.begin(), piece.end(), std::size_t{0});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (piece[i] == piece[k]) continue;
      if (relative_variance_m2(joint.covariance, row_of(pairs[i]), row_of(pairs[k])) > half_m * half_m) continue;
      std::replace(piece.begin(), piece.end(), std::size_t{piece[i]}, std::size_t{piece[k]});
    }
  }
  return piece;
}

}  // namespace

std::vector<ConstellationPair> tied_pairs(const cekf::CompressedEkf& filter,
                                          const std::vector<ConstellationPair>& pairs) {
  if (pairs.size() < 2) return pairs;
  const std::vector<std::size_t> piece = pieces_of(filter, pairs);
  std::vector<std::ptrdiff_t> size(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) size[i] = std::count(piece.begin(), piece.end(), piece[i]);
  const std::ptrdiff_t largest = *std::max_element(size.begin(), size.end());
  std::vector<ConstellationPair> tied;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (2 * size[i] >= largest) tied.push_back(pairs[i]);
  }
  return tied;
}

}  // namespace helixnav::supervisor
