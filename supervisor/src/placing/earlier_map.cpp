// SPDX-License-Identifier: BSD-3-Clause
#include "placing/earlier_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "placing/index_traits.hpp"
#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t most_related = 12;

using Near = std::vector<std::pair<double, std::size_t>>;

/// Those of `candidates` within reach of a landmark that are nearest to it, itself included, by distance.
template <class Candidates>
Near nearest_to(const std::vector<Eigen::Vector2d>& points_m, std::size_t landmark, double reach_m,
                const Candidates& candidates) {
  Near near;
  for (const std::size_t i : candidates) {
    const double distance_m = (points_m[i] - points_m[landmark]).norm();
    if (distance_m <= reach_m) near.emplace_back(distance_m, i);
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most_related, near.size()));
  std::partial_sort(near.begin(), near.begin() + kept, near.end());
  near.resize(static_cast<std::size_t>(kept));
  return near;
}

/// Of the landmark among its neighbours; `row_of`: its row in the covariance.
template <class RowOf>
Eigen::Matrix2d covariance_among(const Near& near, std::size_t landmark, const std::vector<Eigen::Vector2d>& points_m,
                                 const Eigen::MatrixXd& covariance, const RowOf& row_of) {
  std::vector<Eigen::Vector2d> near_m;
  std::vector<Eigen::Index> rows;
  std::size_t own = 0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (near[k].second == landmark) own = k;
    near_m.push_back(points_m[near[k].second]);
    const Eigen::Index row = row_of(near[k].second);
    rows.insert(rows.end(), {row, row + 1});
  }
  return relative_covariances(near_m, covariance(rows, rows))[own];
}

/// Landmarks by square, so that neighbours are in the same square or one beside it.
class Squares {
 public:
  using Square = std::pair<long, long>;

  Squares(const std::vector<Eigen::Vector2d>& points_m, double side_m) {
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      const Eigen::Vector2d at = points_m[i] / side_m;
      in_[{std::lround(std::floor(at.x())), std::lround(std::floor(at.y()))}].push_back(i);
    }
  }

  const std::map<Square, std::vector<std::size_t>>& all() const { return in_; }

  std::vector<std::size_t> about(const Square& square) const {
    std::vector<std::size_t> about;
    for (long x = square.first - 1; x <= square.first + 1; ++x) {
      for (long y = square.second - 1; y <= square.second + 1; ++y) {
        const auto found = in_.find({x, y});
        if (found != in_.end()) about.insert(about.end(), found->second.begin(), found->second.end());
      }
    }
    std::sort(about.begin(), about.end());
    return about;
  }

 private:
  std::map<Square, std::vector<std::size_t>> in_;
};

bool fits_together(const core::JointMap& map) {
  const core::JointGaussian& all = map.joint;
  const bool has_marginals = map.factors != nullptr && map.covariances_m2.size() == all.ids.size();
  return map.states.size() == all.ids.size() && map.observations.size() == all.ids.size() &&
         (map.appearances.empty() || map.appearances.size() == all.ids.size()) &&
         (map.has_covariance() || has_marginals) && all.points_m.size() == all.ids.size() &&
         all.covariance.rows() >= 3 && all.covariance.rows() == all.covariance.cols() &&
         std::adjacent_find(all.ids.begin(), all.ids.end(), std::greater_equal<>()) == all.ids.end() &&
         (all.ids.empty() || (all.ids.front() >= 0 && all.ids.back() < map.next_name));
}

}  // namespace

void check_earlier_map(const core::JointMap& map) {
  if (!fits_together(map)) throw core::PreconditionError("earlier map: its parts do not fit each other");
}

bool goes_on_behind(const core::JointMap& map, const SearchOptions& options) {
  const bool keeps_drive = options.enabled && options.closing != ClosingMethod::restart;
  if (map.factors != nullptr && keeps_drive) return true;
  if (map.has_covariance()) return false;
  throw core::PreconditionError(
      "earlier map: a map without a joint covariance cannot be continued in without searches, or with closings by "
      "restart");
}

double mapped_reach_m(const core::JointMap& map) { return map.reach_m > 0.0 ? map.reach_m : reference_reach_m; }

EarlierMap::EarlierMap(const core::JointMap& map) : next_name_(map.next_name) {
  check_earlier_map(map);
  const core::JointGaussian& all = map.joint;
  std::vector<Eigen::Index> rows{0, 1, 2};
  landmarks_.pose = all.pose;
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    if (map.states[i] != core::LandmarkState::mature) continue;
    landmarks_.ids.push_back(all.ids[i]);
    landmarks_.points_m.push_back(all.points_m[i]);
    observations_.push_back(map.observations[i]);
    if (!map.appearances.empty()) appearance_.adopt(all.ids[i], map.appearances[i]);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    rows.insert(rows.end(), {row, row + 1});
  }
  if (map.has_covariance()) landmarks_.covariance = all.covariance(rows, rows);
  if (map.factors != nullptr) {
    drive_ = std::make_shared<const DriveMap>(DriveMap::of_earlier(map, phase_length_m(mapped_reach_m(map))));
  }
}

core::PointGaussian EarlierMap::relative_to_neighbours(std::size_t landmark, double reach_m) const {
  std::vector<std::size_t> all(landmarks_.ids.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<Eigen::Vector2d>& points_m = landmarks_.points_m;
  const auto row_of = [](std::size_t i) { return 3 + 2 * static_cast<Eigen::Index>(i); };
  return {points_m[landmark], covariance_among(nearest_to(points_m, landmark, reach_m, all), landmark, points_m,
                                               landmarks_.covariance, row_of)};
}

std::vector<core::PointGaussian> EarlierMap::relative_to_neighbours(double reach_m) const {
  if (drive_ != nullptr) return relative_by_squares(reach_m);
  std::vector<core::PointGaussian> relative;
  for (std::size_t i = 0; i < landmarks_.ids.size(); ++i) relative.push_back(relative_to_neighbours(i, reach_m));
  return relative;
}

/// Square by square: the joint marginal of a square and those around it has all that its landmarks need.
std::vector<core::PointGaussian> EarlierMap::relative_by_squares(double reach_m) const {
  const std::vector<Eigen::Vector2d>& points_m = landmarks_.points_m;
  std::vector<core::PointGaussian> relative(points_m.size());
  const Squares squares(points_m, reach_m);
  for (const auto& [square, landmarks] : squares.all()) {
    const std::vector<std::size_t> about = squares.about(square);
    std::vector<Near> near_of;
    std::vector<core::LandmarkId> ids;
    for (const std::size_t i : landmarks) {
      near_of.push_back(nearest_to(points_m, i, reach_m, about));
      for (const auto& [distance_m, neighbour] : near_of.back()) ids.push_back(landmarks_.ids[neighbour]);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const core::JointGaussian joint = drive_->atlas().joint(ids);
    const auto row_of = [&](std::size_t i) {
      const auto at = std::lower_bound(ids.begin(), ids.end(), landmarks_.ids[i]) - ids.begin();
      return 3 + 2 * static_cast<Eigen::Index>(at);
    };
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      const std::size_t i = landmarks[k];
      relative[i] = {points_m[i], covariance_among(near_of[k], i, points_m, joint.covariance, row_of)};
    }
  }
  return relative;
}

core::JointGaussian EarlierMap::landmarks_about(const Eigen::Vector2d& center_m, double radius_m,
                                                std::size_t most) const {
  std::vector<std::pair<double, core::LandmarkId>> near;
  for (std::size_t i = 0; i < landmarks_.ids.size(); ++i) {
    const double distance_m = (landmarks_.points_m[i] - center_m).norm();
    if (distance_m <= radius_m) near.emplace_back(distance_m, landmarks_.ids[i]);
  }
  std::sort(near.begin(), near.end());
  std::vector<core::LandmarkId> ids;
  for (std::size_t k = 0; k < std::min(most, near.size()); ++k) ids.push_back(near[k].second);
  std::sort(ids.begin(), ids.end());
  return drive_->atlas().joint(ids);
}

relocalize::MapIndex EarlierMap::index(const relocalize::IndexOptions& lengths) const {
  const double half_m2 = 0.5 * lengths.pair_noise_m * lengths.pair_noise_m;
  const double farthest_m = 3e5 * lengths.pair_noise_m;  // beyond, an index cannot hold it, and nobody drives there
  const std::vector<core::PointGaussian> relative = relative_to_neighbours(lengths.reach_m);
  std::vector<relocalize::Landmark> landmarks;
  for (std::size_t i = 0; i < landmarks_.ids.size(); ++i) {
    if ((landmarks_.points_m[i] - landmarks_.points_m[0]).norm() > farthest_m) continue;
    relocalize::Landmark& landmark = landmarks.emplace_back();
    landmark.id = landmarks_.ids[i];
    landmark.point = relative[i];
    landmark.point.covariance_m2 += half_m2 * Eigen::Matrix2d::Identity();
    tell_traits(appearance_.of(landmark.id), landmark);
  }
  relocalize::MapIndex index(lengths, landmarks);
  index.look_around_landmarks();
  return index;
}

}  // namespace helixnav::supervisor
