// SPDX-License-Identifier: BSD-3-Clause
#include "placing/session_leftovers.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "association/median.hpp"
#include "helixnav/core/rigid_fit.hpp"

namespace helixnav::supervisor {
namespace {

/// Median distance of a map's landmarks to their nearest neighbours; 0 for a map of one.
double spacing_of(const std::vector<Eigen::Vector2d>& points_m) {
  std::vector<double> nearest_m;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < points_m.size(); ++j) {
      if (j != i) least_m = std::min(least_m, (points_m[j] - points_m[i]).norm());
    }
    nearest_m.push_back(least_m);
  }
  return nearest_m.size() < 2 ? 0.0 : median(std::move(nearest_m));
}

/// A session that was placed late is off by metres where it began: how far a copy may be from its landmark is limited
/// by the map's own spacing, not by what a closing assumes of any map.
SearchOptions with_spacing(SearchOptions options, double spacing_m) {
  options.leftover_most_m = std::max(options.leftover_most_m, leftover_reach_share * spacing_m);
  return options;
}

/// Ground that was surely looked at, from the landmarks alone: where two of the discs around them overlap, 0.6 of the way to the eighth
/// neighbour, of which the median is taken (as relocalize::ground_around for a constellation).
pf_relocalize::Coverage ground_of(const std::vector<Eigen::Vector2d>& points_m, double most_m) {
  constexpr double share_of_eighth = 0.6;
  pf_relocalize::Coverage ground;
  std::vector<double> radii_m;
  for (const Eigen::Vector2d& at_m : points_m) {
    std::vector<double> others_m;
    for (const Eigen::Vector2d& other_m : points_m) others_m.push_back((other_m - at_m).norm());
    const auto eighth = others_m.begin() + std::min<std::ptrdiff_t>(8, std::ptrdiff_t(others_m.size()) - 1);
    std::nth_element(others_m.begin(), eighth, others_m.end());
    radii_m.push_back(share_of_eighth * std::min(*eighth, most_m));
    ground.T_frame_sensor.emplace_back(at_m.x(), at_m.y(), 0.0);
  }
  ground.field_of_view = {0.0, median(std::move(radii_m)), -core::pi, core::pi};
  ground.range_share = 1.0;
  ground.least_views = 2;
  return ground;
}

Branch branch_of(const cekf::CompressedEkf& filter, const core::JointGaussian& earlier,
                 const std::vector<core::LandmarkId>& confirmed, const SearchOptions& options) {
  Branch branch;
  branch.confirmed = confirmed;
  std::vector<Eigen::Vector2d> own_m;
  for (const core::LandmarkId id : confirmed) own_m.push_back(filter.landmark_mean(id));
  branch.old_drive = ground_of(earlier.points_m, options.stretch_m);
  branch.new_drive = ground_of(own_m, options.stretch_m);
  return branch;
}

bool has_taken(const Closing& closing, core::LandmarkId kept) {
  return std::any_of(closing.merged.begin(), closing.merged.end(), [&](const auto& one) { return one.kept == kept; });
}

}  // namespace

SessionLeftovers::SessionLeftovers(const cekf::CompressedEkf& filter, const core::JointGaussian& earlier,
                                   std::vector<core::LandmarkId> confirmed, const SearchOptions& across)
    : across_(across),
      confirmed_(std::move(confirmed)),
      old_(earlier.ids),
      spacing_m_(spacing_of(earlier.points_m)),
      segments_(filter, branch_of(filter, earlier, confirmed_, across)) {}

int most_dropped_of(std::size_t pairs) {
  constexpr int share_dropped = 8;  // one pair in so many
  return std::max(1, static_cast<int>(pairs) / share_dropped);
}

void SessionLeftovers::merge_one_by_one(cekf::CompressedEkf& filter, Closing& closing) const {
  merge_those(filter, closing, [](const auto&) { return true; });
}

template <class MayBe>
void SessionLeftovers::merge_those(cekf::CompressedEkf& filter, Closing& closing, MayBe may_be) const {
  const SearchOptions options = with_spacing(across_, spacing_m_);
  while (true) {
    KeptRemoved rest = leftovers(filter, confirmed_, old_, options);
    rest.erase(std::remove_if(rest.begin(), rest.end(), [&](const auto& pair) { return !may_be(pair); }), rest.end());
    Closing rest_closing;
    if (rest.empty() || !make_compatible(filter, options, rest, rest_closing)) return;
    filter.merge(rest, options.merge_sigma_m);
    note(rest, closing);
  }
}

/// The merged pairs nearest to where a landmark was before the join, within a stretch of it.
KeptRemoved SessionLeftovers::merged_around(core::LandmarkId id, const Closing& closing) const {
  constexpr std::size_t enough = 8;
  KeptRemoved near;
  for (const core::MergedLandmarks& one : closing.merged) {
    if (distance_m(one.removed, id) <= across_.stretch_m) near.emplace_back(one.kept, one.removed);
  }
  const std::size_t count = std::min(enough, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                    [&](const auto& a, const auto& b) { return distance_m(a.second, id) < distance_m(b.second, id); });
  near.resize(count);
  return near;
}

double SessionLeftovers::distance_m(core::LandmarkId a, core::LandmarkId b) const {
  return (segments_.before_m(a) - segments_.before_m(b)).norm();
}

/// Whether the session's own map, put onto the pairs around this one, has it where they are one: as near as a stretch is rigid.
bool SessionLeftovers::agrees(const cekf::CompressedEkf& filter, const cekf::CompressedEkf::LandmarkPair& pair,
                              const Closing& closing) const {
  const pf_relocalize::ConstellationLimits& limits = across_.constellation;
  const KeptRemoved near = merged_around(pair.second, closing);
  if (near.size() < least_pairs || has_taken(closing, pair.first)) return false;
  std::vector<Eigen::Vector2d> kept_m, removed_m;
  double lever_m = 0.0;
  for (const auto& [kept, removed] : near) {
    kept_m.push_back(filter.landmark_mean(kept));
    removed_m.push_back(segments_.before_m(removed));
    lever_m += distance_m(removed, pair.second) / static_cast<double>(near.size());
  }
  const double tolerance_m =
      std::min(3.0 * limits.branch_sigma_m + limits.lever_rad * lever_m, limits.most_tolerance_m);
  const Eigen::Vector2d on_map_m =
      core::transform(core::fit_rigidly(kept_m, removed_m), segments_.before_m(pair.second));
  return (on_map_m - filter.landmark_mean(pair.first)).norm() <= tolerance_m;
}

/// A segment that contradicts the rest of the join is none: as few of its pairs may be dropped as of the pairs of a place.
SearchOptions SessionLeftovers::for_segment(std::size_t pairs) const {
  SearchOptions options = across_;
  options.most_dropped = std::min(options.most_dropped, most_dropped_of(pairs));
  return options;
}

void SessionLeftovers::merge_segments(cekf::CompressedEkf& filter, Closing& closing) const {
  std::vector<core::LandmarkId> tried;
  while (std::optional<KeptRemoved> placed = segments_.place_next(filter, old_, across_, tried)) {
    const bool is_taken =
        std::any_of(placed->begin(), placed->end(), [&](const auto& pair) { return has_taken(closing, pair.first); });
    Closing of_segment;
    if (placed->empty() || is_taken || !make_compatible(filter, for_segment(placed->size()), *placed, of_segment)) {
      continue;
    }
    filter.merge(*placed, across_.merge_sigma_m);
    note(*placed, closing);
    merge_those(filter, closing, [&](const auto& pair) { return agrees(filter, pair, closing); });
    tried.clear();
  }
}

}  // namespace helixnav::supervisor
