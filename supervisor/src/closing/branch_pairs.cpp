// SPDX-License-Identifier: BSD-3-Clause
#include "closing/branch_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "closing/contradicting_pairs.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/rigid_fit.hpp"

namespace helixnav::supervisor {
namespace {

/// Distance from an old landmark to its nearest old neighbour, as far as that matters.
double nearest_old_m(const cekf::CompressedEkf& filter, core::LandmarkId kept, const std::vector<core::LandmarkId>& old,
                     double matters_m) {
  const Eigen::Vector2d at_m = filter.landmark_mean(kept);
  double nearest_m = matters_m;
  for (const core::LandmarkId other : filter.landmarks_within(at_m, nearest_m)) {
    if (other == kept || !std::binary_search(old.begin(), old.end(), other)) continue;
    nearest_m = std::min(nearest_m, (filter.landmark_mean(other) - at_m).norm());
  }
  return nearest_m;
}

/// At the rim of the mapped ground a copy has only one partner, right or wrong. Is it a thousand times likelier to be a
/// copy of that one than of an unmapped neighbour, on any side and as near as the nearest one is? The copies of one
/// segment share their error, so a likelier mistake would be one of whole rows in one of some hundred closings.
bool may_be_a_neighbours(const Leftover& leftover, double neighbour_m) {
  constexpr int sides = 16;
  static const double least_excess = 2.0 * std::log(1000.0);
  for (int k = 0; k < sides; ++k) {
    const double angle_rad = 2.0 * core::pi * k / sides;
    const Eigen::Vector2d d =
        leftover.difference_m - neighbour_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    if (d.dot(leftover.information * d) < leftover.nis + least_excess) return true;
  }
  return false;
}

}  // namespace

std::optional<cekf::CostByPart> cost_of(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m) {
  try {
    return filter.merge_cost(pairs, sigma_m);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

bool try_merge(cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m) {
  try {
    filter.merge(pairs, sigma_m);
    return true;
  } catch (const core::NumericalError&) {
    return false;
  }
}

KeptRemoved kept_removed(const std::vector<pf_relocalize::ConstellationPair>& pairs) {
  KeptRemoved result;
  for (const pf_relocalize::ConstellationPair& pair : pairs) result.emplace_back(pair.old_landmark, pair.branch);
  return result;
}

core::Pose2 fitted_to_pairs(const cekf::CompressedEkf& filter, const KeptRemoved& pairs) {
  std::vector<Eigen::Vector2d> kept_m, removed_m;
  for (const auto& [kept, removed] : pairs) {
    kept_m.push_back(filter.landmark_mean(kept));
    removed_m.push_back(filter.landmark_mean(removed));
  }
  return core::fit_rigidly(kept_m, removed_m);
}

void note(const KeptRemoved& pairs, Closing& closing) {
  for (const auto& [kept, removed] : pairs) closing.merged.push_back({kept, removed});
}

namespace {

/// One of few pairs, after which the rest is solved again; of many, as sessions share, all that contradict the rest.
std::vector<std::size_t> worst_pairs(const cekf::CompressedEkf& filter, const SearchOptions& options,
                                     const std::vector<double>& parts, const KeptRemoved& pairs, MayLeaveOut may) {
  constexpr std::size_t many = 64;
  if (pairs.size() > many || may.any == 0) {
    return contradicting_pairs(filter, pairs, options.merge_sigma_m, options.closing_probability, may);
  }
  return {static_cast<std::size_t>(std::max_element(parts.begin(), parts.end()) - parts.begin())};
}

/// Some pairs of a correct closing are wrong, each far beyond its deviation: where trees grow as twins, or clutter gathers in the same
/// bush on both passes. Without as many as that the place still explains more than any rival of it does.
MayLeaveOut may_still_leave_out(const SearchOptions& options, const Closing& closing, std::size_t pairs) {
  const auto any = static_cast<std::size_t>(options.most_dropped);
  const auto dropped = static_cast<std::size_t>(closing.dropped);
  const auto outliers =
      static_cast<std::size_t>((1.0 - options.constellation.rival_ratio) * static_cast<double>(pairs + dropped));
  const std::size_t all = std::max(any, outliers);
  const std::size_t left_any = any - std::min(any, dropped);
  return {left_any, all - std::min(all, dropped + left_any)};
}

}  // namespace

bool make_compatible(const cekf::CompressedEkf& filter, const SearchOptions& options, KeptRemoved& pairs,
                     Closing& closing, int free_dof) {
  while (true) {
    const std::optional<cekf::CostByPart> cost = cost_of(filter, pairs, options.merge_sigma_m);
    closing.cost = cost ? cost->cost : 0.0;
    closing.dof = cost ? cost->dof - free_dof : 0;
    closing.limit = cost ? core::chi2_quantile(options.closing_probability, closing.dof) : 0.0;
    if (!cost) {
      ++closing.numerics.refused;
      return false;
    }
    if (cost->cost <= closing.limit) return true;
    const MayLeaveOut may = may_still_leave_out(options, closing, pairs.size());
    if (may.any + may.outliers == 0 || pairs.size() <= least_pairs) return false;
    const std::vector<std::size_t> worst = worst_pairs(filter, options, cost->parts, pairs, may);
    if (worst.empty()) return false;
    for (std::size_t k = worst.size(); k-- > 0;) pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(worst[k]));
    closing.dropped += static_cast<int>(worst.size());
  }
}

bool is_surely_a_duplicate(const Leftover& leftover, double neighbour_m, const SearchOptions& options) {
  const double reach_m = std::max(options.leftover_least_m, leftover_reach_share * neighbour_m);
  return leftover.difference_m.norm() <= reach_m && !may_be_a_neighbours(leftover, neighbour_m);
}

KeptRemoved leftovers(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& confirmed,
                      const std::vector<core::LandmarkId>& old, const SearchOptions& options,
                      const core::MapAppearance& appearance) {
  const double gate = options.leftover_gate;
  const std::vector<core::LandmarkId> ids = held_by(filter, confirmed);
  std::vector<double> look_m;
  for (const core::LandmarkId id : ids) {
    look_m.push_back(options.leftover_most_m + std::sqrt(gate) * filter.landmark_sigma_bound_m(id));
  }
  std::vector<Leftover> found;
  for (const auto& here : compatible(filter, ids, old, look_m, {gate, options.duplicate_sigma_m, appearance})) {
    if (here.size() != 1) continue;
    const double neighbour_m =
        nearest_old_m(filter, here.front().kept, old, options.leftover_most_m / leftover_reach_share);
    if (is_surely_a_duplicate(here.front(), neighbour_m, options)) found.push_back(here.front());
  }
  std::sort(found.begin(), found.end(), [](const Leftover& a, const Leftover& b) { return a.nis < b.nis; });
  KeptRemoved pairs;
  for (const Leftover& leftover : found) {
    const bool taken = std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == leftover.kept; });
    if (!taken) pairs.emplace_back(leftover.kept, leftover.removed);
  }
  return pairs;
}

void forget_copies(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& unconfirmed,
                   const std::vector<core::LandmarkId>& old, const SearchOptions& options, Closing& closing,
                   const core::MapAppearance& appearance) {
  const std::vector<core::LandmarkId> ids = held_by(filter, unconfirmed);
  const auto found = compatible(filter, ids, old, std::vector<double>(ids.size(), options.leftover_least_m),
                                {options.leftover_gate, options.duplicate_sigma_m, appearance});
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (found[i].empty()) continue;
    filter.remove(ids[i]);
    closing.forgotten.push_back(ids[i]);
  }
}

}  // namespace helixnav::supervisor
