// SPDX-License-Identifier: BSD-3-Clause
#include "close_by_merge.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

using KeptRemoved = std::vector<cekf::CompressedEkf::LandmarkPair>;

constexpr double leftover_reach_m = 1.0;  // beyond it, compatible only means uncertain
constexpr std::size_t least_pairs = 3;

void note(const KeptRemoved& pairs, Closing& closing) {
  for (const auto& [kept, removed] : pairs) closing.merged.push_back({kept, removed});
}

/// Drops the worst pair until the cost passes; false when too many would have to go.
bool make_compatible(const cekf::CompressedEkf& filter, const SearchOptions& options, KeptRemoved& pairs,
                     Closing& closing) {
  while (true) {
    const cekf::CostByPart cost = filter.merge_cost(pairs, options.merge_sigma_m);
    closing.cost = cost.cost;
    closing.dof = cost.dof;
    closing.limit = core::chi2_quantile(options.closing_probability, cost.dof);
    if (cost.cost <= closing.limit) return true;
    if (closing.dropped == options.most_dropped || pairs.size() <= least_pairs) return false;
    const auto worst = std::max_element(cost.parts.begin(), cost.parts.end()) - cost.parts.begin();
    pairs.erase(pairs.begin() + worst);
    ++closing.dropped;
  }
}

struct Leftover {
  core::LandmarkId kept, removed;
  double nis;
};

/// Squared Mahalanobis distance of two landmarks, correlations included, on top of 1 cm each way.
double squared_distance(const cekf::CompressedEkf& filter, core::LandmarkId a, core::LandmarkId b) {
  const core::JointGaussian both = filter.joint({a, b});
  const Eigen::MatrixXd& P = both.covariance;
  const Eigen::Matrix2d S = P.block<2, 2>(3, 3) + P.block<2, 2>(5, 5) - P.block<2, 2>(3, 5) - P.block<2, 2>(5, 3) +
                            1e-4 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d d = both.points_m[1] - both.points_m[0];
  return d.dot(S.inverse() * d);
}

/// Old landmarks that `id` stands on, nearest first.
std::vector<Leftover> stands_on(const cekf::CompressedEkf& filter, core::LandmarkId id,
                                const std::vector<core::LandmarkId>& old, double gate) {
  std::vector<Leftover> found;
  for (const core::LandmarkId kept : filter.landmarks_within(filter.landmark_mean(id), leftover_reach_m)) {
    if (!std::binary_search(old.begin(), old.end(), kept)) continue;
    const double nis = squared_distance(filter, kept, id);
    if (nis < gate) found.push_back({kept, id, nis});
  }
  std::sort(found.begin(), found.end(), [](const Leftover& a, const Leftover& b) { return a.nis < b.nis; });
  return found;
}

/// Confirmed branch landmarks that stand on one old landmark and on no other, by the joint covariance of the closed map.
KeptRemoved leftovers(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& confirmed,
                      const std::vector<core::LandmarkId>& old, double gate) {
  std::vector<Leftover> found;
  for (const core::LandmarkId id : confirmed) {
    if (!filter.contains(id)) continue;
    const std::vector<Leftover> here = stands_on(filter, id, old, gate);
    if (here.size() == 1) found.push_back(here.front());
  }
  std::sort(found.begin(), found.end(), [](const Leftover& a, const Leftover& b) { return a.nis < b.nis; });
  KeptRemoved pairs;
  for (const Leftover& leftover : found) {
    const bool taken = std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == leftover.kept; });
    if (!taken) pairs.emplace_back(leftover.kept, leftover.removed);
  }
  return pairs;
}

/// Each pass draws the branch nearer to the old map, so that copies farther along come within reach in the next.
void merge_leftovers(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& confirmed,
                     const std::vector<core::LandmarkId>& old, const SearchOptions& options, Closing& closing) {
  constexpr int most_passes = 10;
  for (int pass = 0; pass < most_passes; ++pass) {
    KeptRemoved rest = leftovers(filter, confirmed, old, options.leftover_gate);
    Closing rest_closing;
    if (rest.empty() || !make_compatible(filter, options, rest, rest_closing)) return;
    filter.merge(rest, options.merge_sigma_m);
    note(rest, closing);
  }
}

}  // namespace

Closing close_by_merge(cekf::CompressedEkf& filter, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                       const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options) {
  Closing closing;
  KeptRemoved chosen;
  for (const pf_relocalize::ConstellationPair& pair : pairs) chosen.emplace_back(pair.old_landmark, pair.branch);
  if (chosen.size() < least_pairs || !make_compatible(filter, options, chosen, closing)) return closing;
  filter.merge(chosen, options.merge_sigma_m);
  note(chosen, closing);
  closing.accepted = true;

  merge_leftovers(filter, branch.confirmed, old, options, closing);
  for (const core::LandmarkId id : branch.unconfirmed) {
    if (stands_on(filter, id, old, options.leftover_gate).empty()) continue;
    filter.remove(id);
    closing.forgotten.push_back(id);
  }
  return closing;
}

}  // namespace helixnav::supervisor
