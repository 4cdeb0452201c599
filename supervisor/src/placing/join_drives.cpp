// SPDX-License-Identifier: BSD-3-Clause
#include "placing/join_drives.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "closing/branch_pairs.hpp"
#include "closing/mapped_twice.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "placing/session_leftovers.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// Without those that were merged with another one.
std::vector<LandmarkId> left_of(const std::vector<LandmarkId>& ids, const std::vector<core::MergedLandmarks>& merged) {
  std::vector<LandmarkId> removed, left;
  for (const core::MergedLandmarks& one : merged) removed.push_back(one.removed);
  std::sort(removed.begin(), removed.end());
  std::set_difference(ids.begin(), ids.end(), removed.begin(), removed.end(), std::back_inserter(left));
  return left;
}

cekf::CompressedEkf filter_of(const DriveMap& both, const std::vector<LandmarkId>& of_map,
                              const std::vector<LandmarkId>& of_session, const cekf::CompressedEkf& like) {
  std::vector<LandmarkId> ids;
  std::set_union(of_map.begin(), of_map.end(), of_session.begin(), of_session.end(), std::back_inserter(ids));
  return {both.atlas().joint(ids), like.next_name(), like.options()};
}

/// What the solution shows to be one: of the session and the map, then of either. There the noise between two drives does not count:
/// twin stems stand no farther apart than a few of its standard deviations.
Closing more_pairs(cekf::CompressedEkf filter, const std::vector<LandmarkId>& of_map,
                   const std::vector<LandmarkId>& of_session, const SearchOptions& within,
                   const SearchOptions& across) {
  const core::JointGaussian earlier = filter.joint(of_map);
  const SessionLeftovers left(filter, earlier, of_session, across);
  Closing closing;
  left.merge_one_by_one(filter, closing);
  if (!closing.merged.empty()) return closing;
  KeptRemoved twice = mapped_twice(filter, filter.landmarks(), within);
  if (!twice.empty() && make_compatible(filter, within, twice, closing)) note(twice, closing);
  return closing;
}

std::shared_ptr<const core::MapFactors> factors_of(const DriveMap& both, const cekf::CompressedEkf& filter) {
  std::vector<core::MapLandmark> landmarks;
  for (const LandmarkId id : filter.landmarks()) landmarks.emplace_back().id = id;
  return factored_map(both.atlas(), filter.next_name(), landmarks, FactoredMap::factors_alone).factors;
}

/// The drives' own noise is white, and what two of them see of one landmark differs by more.
bool is_contradicted(double chi2, std::size_t pairs, const SearchOptions& options) {
  constexpr double of_half_noise = 4.0;
  const int dof = std::max(1, 2 * static_cast<int>(pairs) - 3);
  return chi2 > of_half_noise * core::chi2_quantile(options.closing_probability, dof);
}

}  // namespace

std::optional<JoinedDrives> join_drives(const DriveMap& map, const std::vector<LandmarkId>& of_map,
                                        const DriveMap& session, const std::vector<LandmarkId>& of_session,
                                        const JoinedMaps& joined, const SearchOptions& within,
                                        const SearchOptions& across) {
  constexpr int most_rounds = 10;
  try {
    DriveMap both = map.followed_by(session, joined.T_map_session, joined.closing.merged);
    Closing closing = joined.closing;
    std::vector<LandmarkId> old = of_map, left = left_of(of_session, closing.merged);
    cekf::CompressedEkf filter = filter_of(both, old, left, joined.filter);
    for (int round = 0; round < most_rounds; ++round) {
      const Closing more = more_pairs(filter, old, left, within, across);
      if (more.merged.empty()) break;
      both.merge(more.merged);
      both.settle();
      closing.merged.insert(closing.merged.end(), more.merged.begin(), more.merged.end());
      old = left_of(old, more.merged);
      left = left_of(left, more.merged);
      filter = filter_of(both, old, left, joined.filter);
    }
    const double chi2 = both.atlas().chi2() - map.atlas().chi2() - session.atlas().chi2();
    if (is_contradicted(chi2, closing.merged.size(), across)) return std::nullopt;
    auto factors = factors_of(both, filter);
    return JoinedDrives{{std::move(filter), std::move(closing), joined.T_map_session}, std::move(factors)};
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

}  // namespace helixnav::supervisor
