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

/// The old landmark that stays and the one of the branch that goes.
using KeptRemoved = std::vector<cekf::CompressedEkf::LandmarkPair>;

constexpr std::size_t least_pairs = 3;  ///< of a closing

/// Of the distance of old landmarks a third says well enough who is whose copy.
constexpr double leftover_reach_share = 0.35;

KeptRemoved kept_removed(const std::vector<pf_relocalize::ConstellationPair>& pairs);

/// An old landmark that a landmark of the branch may be a duplicate of.
struct Leftover {
  core::LandmarkId kept, removed;
  Eigen::Vector2d difference_m;  ///< removed less kept
  Eigen::Matrix2d information;   ///< of it, correlations included, on top of duplicate_sigma_m each way
  double nis;
};

/// What a landmark may be a duplicate of: by the difference of the two, and how far from it that is looked for.
struct Likeness {
  double gate;  ///< of the difference's NIS
  double sigma_m;
  const core::MapAppearance& appearance;
};

/// Those that the filter holds: others were removed, or are in a part that it leaves out.
std::vector<core::LandmarkId> held_by(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& ids);

/// For each of `ids` the old landmarks (ascending) within its look_m that it may be a duplicate of, nearest first: those that do not
/// look different.
std::vector<std::vector<Leftover>> compatible(const cekf::CompressedEkf& filter,
                                              const std::vector<core::LandmarkId>& ids,
                                              const std::vector<core::LandmarkId>& old,
                                              const std::vector<double>& look_m, const Likeness& likeness);

/// The cost of merging them; nothing where the map is so uncertain, by hundreds of metres and tens of degrees, that rounding of
/// its covariance is larger than what the pairs are known by.
std::optional<cekf::CostByPart> cost_of(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m);

/// Adds the pairs to what the closing merged.
void note(const KeptRemoved& pairs, Closing& closing);

/// Drops the worst pair until the cost of merging the rest passes; false when too many would have to go. Sets the
/// figures of `closing`; false and no degrees of freedom where the cost cannot be computed.
bool make_compatible(const cekf::CompressedEkf& filter, const SearchOptions& options, KeptRemoved& pairs,
                     Closing& closing);

/// Confirmed branch landmarks that are compatible with one landmark of `old` (ascending) and with no other, by the
/// joint covariance of the closed map, a thousand times likelier it than an unmapped one as near to it as its nearest
/// old neighbour on another side, and not farther from it than a third of that distance, leftover_least_m at the least
/// and leftover_most_m at the most; of several on the same one the nearest. Test: supervisor/closing/branch_pairs_test.cpp.
KeptRemoved leftovers(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& confirmed,
                      const std::vector<core::LandmarkId>& old, const SearchOptions& options,
                      const core::MapAppearance& appearance = {});

/// Removes unconfirmed landmarks of the branch that stand on an old one: they may be clutter and are never merged.
void forget_copies(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& unconfirmed,
                   const std::vector<core::LandmarkId>& old, const SearchOptions& options, Closing& closing,
                   const core::MapAppearance& appearance = {});

}  // namespace helixnav::supervisor
