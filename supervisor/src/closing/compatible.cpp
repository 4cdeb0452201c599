// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <Eigen/LU>

#include "closing/branch_pairs.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// Some of the landmarks in question, and all old ones that any of them may be, ascending.
struct Neighbourhood {
  std::vector<LandmarkId> ids, old;
  std::vector<std::vector<LandmarkId>> near;  ///< for each of ids
};

Neighbourhood look_around(const cekf::CompressedEkf& filter, std::vector<LandmarkId> ids,
                          const std::vector<LandmarkId>& old, const double* look_m) {
  Neighbourhood about{std::move(ids), {}, {}};
  for (const LandmarkId id : about.ids) {
    std::vector<LandmarkId> near;
    for (const LandmarkId other : filter.landmarks_within(filter.landmark_mean(id), *look_m++)) {
      if (std::binary_search(old.begin(), old.end(), other)) near.push_back(other);
    }
    about.old.insert(about.old.end(), near.begin(), near.end());
    about.near.push_back(std::move(near));
  }
  std::sort(about.old.begin(), about.old.end());
  about.old.erase(std::unique(about.old.begin(), about.old.end()), about.old.end());
  return about;
}

/// One covariance of all with all: the pairs share its rows.
std::vector<std::vector<Leftover>> compare(const cekf::CompressedEkf& filter, const Neighbourhood& about,
                                           const Likeness& likeness) {
  std::vector<std::vector<Leftover>> result(about.ids.size());
  if (about.old.empty()) return result;
  const Eigen::MatrixXd cross = filter.cross_covariance(about.ids, about.old);
  const std::vector<core::PointGaussian> of_id = filter.marginals(about.ids);
  const std::vector<core::PointGaussian> of_old = filter.marginals(about.old);
  const Eigen::Matrix2d added_m2 = likeness.sigma_m * likeness.sigma_m * Eigen::Matrix2d::Identity();
  for (std::size_t i = 0; i < about.ids.size(); ++i) {
    for (const LandmarkId kept : about.near[i]) {
      const auto j = std::lower_bound(about.old.begin(), about.old.end(), kept) - about.old.begin();
      const core::PointGaussian& there = of_old[static_cast<std::size_t>(j)];
      const Eigen::Matrix2d C = cross.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * j);
      const Eigen::Matrix2d S = there.covariance_m2 + of_id[i].covariance_m2 - C - C.transpose() + added_m2;
      const Eigen::Matrix2d information = S.inverse();
      const Eigen::Vector2d d = of_id[i].mean_m - there.mean_m;
      const Leftover leftover{kept, about.ids[i], d, information, d.dot(information * d)};
      const bool fits = leftover.nis < likeness.gate && likeness.appearance.look_alike(kept, about.ids[i]);
      if (fits) result[i].push_back(leftover);
    }
    std::sort(result[i].begin(), result[i].end(), [](const Leftover& a, const Leftover& b) { return a.nis < b.nis; });
  }
  return result;
}

}  // namespace

std::vector<LandmarkId> held_by(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids) {
  std::vector<LandmarkId> held;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(held), [&](LandmarkId id) { return filter.contains(id); });
  return held;
}

std::vector<std::vector<Leftover>> compatible(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids,
                                              const std::vector<LandmarkId>& old, const std::vector<double>& look_m,
                                              const Likeness& likeness) {
  constexpr std::size_t at_once = 64;  // those with neighbouring ids are near each other
  std::vector<std::vector<Leftover>> found;
  for (std::size_t begin = 0; begin < ids.size(); begin += at_once) {
    const auto from = ids.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = ids.begin() + static_cast<std::ptrdiff_t>(std::min(begin + at_once, ids.size()));
    auto part = compare(filter, look_around(filter, {from, to}, old, look_m.data() + begin), likeness);
    found.insert(found.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
  }
  return found;
}

}  // namespace helixnav::supervisor
