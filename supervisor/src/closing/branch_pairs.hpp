// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// The old landmark that is kept and the branch landmark that is removed.
using KeptRemoved = std::vector<cekf::CompressedEkf::LandmarkPair>;

constexpr std::size_t least_pairs = 3;  ///< of a closing

/// A third of the distance between old landmarks is close enough to tell which is a copy of which.
constexpr double leftover_reach_share = 0.35;

KeptRemoved kept_removed(const std::vector<pf_relocalize::ConstellationPair>& pairs);

/// T_map_branch: lays the branch's landmarks, where the filter has them, on their partners. Without covariances.
core::Pose2 fitted_to_pairs(const cekf::CompressedEkf& filter, const KeptRemoved& pairs);

/// An old landmark that a landmark of the branch may be a duplicate of.
struct Leftover {
  core::LandmarkId kept, removed;
  Eigen::Vector2d difference_m;  ///< removed minus kept
  Eigen::Matrix2d information;   ///< of the difference, correlations included, with duplicate_sigma_m added each way
  double nis;
};

/// What a landmark may be a duplicate of: by the difference of the two, and how far from it that is looked for.
struct Likeness {
  double gate;  ///< of the difference's NIS
  double sigma_m;
  const core::MapAppearance& appearance;
};

/// Those of `ids` that the filter holds: others were removed, or are in a part that it leaves out.
std::vector<core::LandmarkId> held_by(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& ids);

/// For each of `ids` the landmarks of `old` (ascending) within its look_m that it may be a duplicate of and that do not
/// look different, nearest first.
std::vector<std::vector<Leftover>> compatible(const cekf::CompressedEkf& filter,
                                              const std::vector<core::LandmarkId>& ids,
                                              const std::vector<core::LandmarkId>& old,
                                              const std::vector<double>& look_m, const Likeness& likeness);

/// The cost of merging them; nothing if the map is so uncertain, by hundreds of metres and tens of degrees, that rounding
/// errors in its covariance are larger than the uncertainty of the pairs.
std::optional<cekf::CostByPart> cost_of(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m);

/// False, with the filter as before, if cost_of would give nothing one iteration later.
bool try_merge(cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m);

/// Adds the pairs to what the closing merged.
void note(const KeptRemoved& pairs, Closing& closing);

/// Drops the worst pair until the cost of merging the rest passes; false if too many would have to go. Sets the
/// figures of `closing`; false and no degrees of freedom if the cost cannot be computed. `free_dof`: what the pairs fit beforehand,
/// 3 for a pose of which nothing else is known.
bool make_compatible(const cekf::CompressedEkf& filter, const SearchOptions& options, KeptRemoved& pairs,
                     Closing& closing, int free_dof = 0);

/// Whether a landmark is as near to the one that it may be a duplicate of as a third of that one's distance to its nearest
/// neighbour, and a thousand times likelier to be that one than one as near as that neighbour on any side.
bool is_surely_a_duplicate(const Leftover& leftover, double neighbour_m, const SearchOptions& options);

/// Confirmed branch landmarks that are compatible with exactly one landmark of `old` (ascending) by the joint
/// covariance of the closed map, a thousand times likelier to be that one than an unmapped one on another side, as near
/// to it as its nearest old neighbour, and no farther from it than a third of that distance, but at least
/// leftover_least_m and at most leftover_most_m; of several at the same one, the nearest.
/// Test: supervisor/closing/branch_pairs_test.cpp.
KeptRemoved leftovers(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& confirmed,
                      const std::vector<core::LandmarkId>& old, const SearchOptions& options,
                      const core::MapAppearance& appearance = {});

/// Removes unconfirmed landmarks of the branch that coincide with an old one: they may be clutter and are never merged.
void forget_copies(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& unconfirmed,
                   const std::vector<core::LandmarkId>& old, const SearchOptions& options, Closing& closing,
                   const core::MapAppearance& appearance = {});

}  // namespace helixnav::supervisor
