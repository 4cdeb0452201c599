// SPDX-License-Identifier: BSD-3-Clause
#include "closing/mapped_twice.hpp"

#include <algorithm>
#include <map>

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using Partners = std::map<LandmarkId, std::vector<Leftover>>;  ///< of each landmark, itself included, by name

bool is_one_of(const std::vector<LandmarkId>& ids, LandmarkId id) {
  return std::binary_search(ids.begin(), ids.end(), id);
}

std::vector<LandmarkId> with_company(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids,
                                     double near_m) {
  std::vector<LandmarkId> close;
  for (const LandmarkId id : ids) {
    const std::vector<LandmarkId> near = filter.landmarks_within(filter.landmark_mean(id), near_m);
    const auto is_other = [&](LandmarkId other) { return other != id && is_one_of(ids, other); };
    if (std::any_of(near.begin(), near.end(), is_other)) close.push_back(id);
  }
  return close;
}

Partners partners_of(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids,
                     const SearchOptions& options, const core::MapAppearance& appearance) {
  const std::vector<double> look_m(ids.size(), options.leftover_most_m);
  const Likeness likeness{options.leftover_gate, options.duplicate_sigma_m, appearance};
  std::vector<std::vector<Leftover>> found = compatible(filter, ids, ids, look_m, likeness);
  Partners partners;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::sort(found[i].begin(), found[i].end(), [](const auto& a, const auto& b) { return a.kept < b.kept; });
    partners[ids[i]] = std::move(found[i]);
  }
  return partners;
}

bool are_same(const std::vector<Leftover>& a, const std::vector<Leftover>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Leftover& one, const Leftover& other) { return one.kept == other.kept; });
}

/// All with all, and each with nothing else.
bool is_group(const Partners& partners, const std::vector<Leftover>& members) {
  return std::all_of(members.begin(), members.end(),
                     [&](const Leftover& one) { return are_same(partners.at(one.kept), members); });
}

/// Distance from the first to the nearest landmark beside the group, as far as that matters.
double nearest_beside_m(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids,
                        const std::vector<Leftover>& group, double matters_m) {
  const Eigen::Vector2d at_m = filter.landmark_mean(group.front().kept);
  double nearest_m = matters_m;
  for (const LandmarkId other : filter.landmarks_within(at_m, matters_m)) {
    const bool is_in_group =
        std::any_of(group.begin(), group.end(), [&](const Leftover& one) { return one.kept == other; });
    if (is_in_group || !is_one_of(ids, other)) continue;
    nearest_m = std::min(nearest_m, (filter.landmark_mean(other) - at_m).norm());
  }
  return nearest_m;
}

}  // namespace

KeptRemoved mapped_twice(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids,
                         const SearchOptions& options, const core::MapAppearance& appearance) {
  const std::vector<LandmarkId> close = with_company(filter, ids, options.leftover_most_m);
  const Partners partners = partners_of(filter, close, options, appearance);
  KeptRemoved pairs;
  for (const auto& [id, group] : partners) {
    if (group.size() < 2 || group.front().kept != id || !is_group(partners, group)) continue;
    const double neighbour_m = nearest_beside_m(filter, ids, group, options.leftover_most_m / leftover_reach_share);
    for (auto member = group.begin() + 1; member != group.end(); ++member) {
      const std::vector<Leftover>& of_member = partners.at(member->kept);
      const Leftover& to_first = of_member.front();  // by name
      if (is_surely_a_duplicate(to_first, neighbour_m, options)) pairs.emplace_back(id, member->kept);
    }
  }
  return pairs;
}

}  // namespace helixnav::supervisor
