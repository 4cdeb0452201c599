// SPDX-License-Identifier: BSD-3-Clause
#include "closing/shape_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "closing/pair_differences.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using Index = Eigen::Index;

constexpr std::size_t most_pairs = 100;  // the nearest: what lies farther back adds little, and all cost its cube

/// What moving and turning the branch as a whole, about the first pair, adds to the differences of its pairs.
Eigen::MatrixXd by_pose(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, const core::Pose2& T) {
  const Eigen::Vector2d middle_m = filter.landmark_mean(pairs.front().first);
  Eigen::MatrixXd rows(2 * static_cast<Index>(pairs.size()), 3);
  for (Index k = 0; k < rows.rows(); k += 2) {
    const LandmarkId removed = pairs[static_cast<std::size_t>(k / 2)].second;
    const Eigen::Vector2d lever_m = core::transform(T, filter.landmark_mean(removed)) - middle_m;
    rows.block<2, 3>(k, 0) << 1.0, 0.0, -lever_m.y(), 0.0, 1.0, lever_m.x();
  }
  return rows;
}

/// Of the branch landmarks that have a pair, those nearest to a point of the branch.
KeptRemoved nearest_pairs(const cekf::CompressedEkf& filter, KeptRemoved pairs, const Eigen::Vector2d& at_m) {
  constexpr std::size_t enough = 8;
  const auto distance_m = [&](const auto& pair) { return (filter.landmark_mean(pair.second) - at_m).norm(); };
  const std::size_t count = std::min(enough, pairs.size());
  std::partial_sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count), pairs.end(),
                    [&](const auto& a, const auto& b) { return distance_m(a) < distance_m(b); });
  pairs.resize(count);
  return pairs;
}

/// Where the pairs around it put a landmark of the branch on the map, and how far from there its partner may be.
struct PlacedByOthers {
  Eigen::Vector2d on_map_m;
  double tolerance_m = 0.0;
};

PlacedByOthers placed_by_others(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, LandmarkId id,
                                const pf_relocalize::ConstellationLimits& limits) {
  const Eigen::Vector2d at_m = filter.landmark_mean(id);
  const KeptRemoved near = nearest_pairs(filter, pairs, at_m);
  double lever_m = 0.0;
  for (const auto& pair : near) {
    lever_m += (filter.landmark_mean(pair.second) - at_m).norm() / static_cast<double>(near.size());
  }
  return {core::transform(fitted_to_pairs(filter, near), at_m),
          std::min(3.0 * limits.branch_sigma_m + limits.lever_rad * lever_m, limits.most_tolerance_m)};
}

/// The old landmark nearest to the place that has no partner yet and does not look different.
std::optional<LandmarkId> nearest_like(const cekf::CompressedEkf& filter, const core::MapAppearance& appearance,
                                       const std::vector<LandmarkId>& old, const std::set<LandmarkId>& taken,
                                       const PlacedByOthers& place, LandmarkId id) {
  std::optional<LandmarkId> nearest;
  double least_m = place.tolerance_m;
  for (const LandmarkId other : filter.landmarks_within(place.on_map_m, place.tolerance_m)) {
    const double distance_m = (filter.landmark_mean(other) - place.on_map_m).norm();
    const bool may_be = std::binary_search(old.begin(), old.end(), other) && taken.count(other) == 0 &&
                        appearance.look_alike(other, id);
    if (!may_be || distance_m >= least_m) continue;
    nearest = other;
    least_m = distance_m;
  }
  return nearest;
}

/// ln of the likelihood that so many of the landmarks on ground that both drives saw have no partner.
double nats_of_partners(const AlongBranch& place) {
  const auto matched = static_cast<double>(place.pairs.size());
  const auto alone = static_cast<double>(place.alone);
  return std::lgamma(matched + 1.0) + std::lgamma(alone + 1.0) - std::lgamma(matched + alone + 2.0);
}

/// With the figures of the other place that explains most landmarks.
core::ShapeDecision decision_for(std::size_t place, const std::vector<AlongBranch>& places,
                                 const std::vector<ShapeCost>& costs) {
  core::ShapeDecision decision;
  decision.place = static_cast<int>(place);
  decision.places = static_cast<int>(places.size());
  decision.pairs = static_cast<int>(places[place].pairs.size());
  decision.alone = places[place].alone;
  decision.chi2 = costs[place].chi2;
  decision.dof = costs[place].dof;
  std::size_t rival = place;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i != place && (rival == place || places[i].pairs.size() > places[rival].pairs.size())) rival = i;
  }
  if (rival == place) return decision;
  decision.rival_pairs = static_cast<int>(places[rival].pairs.size());
  decision.rival_alone = places[rival].alone;
  decision.rival_chi2 = costs[rival].chi2;
  decision.rival_dof = costs[rival].dof;
  return decision;
}

}  // namespace

std::optional<ShapeCost> shape_cost(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m) {
  const core::Pose2 T = fitted_to_pairs(filter, pairs);
  const PairDifferences at = pair_differences(filter, pairs, T, sigma_m);
  const Eigen::MatrixXd along = by_pose(filter, pairs, T);
  const Eigen::LLT<Eigen::MatrixXd> llt(at.S_m2);
  if (llt.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd weighted = llt.solve(at.nu_m);
  const Eigen::MatrixXd of_pose = llt.solve(along);
  const Eigen::Matrix3d information = along.transpose() * of_pose;
  const Eigen::Vector3d pull = of_pose.transpose() * at.nu_m;
  const double chi2 = at.nu_m.dot(weighted) - pull.dot(information.ldlt().solve(pull));
  if (!std::isfinite(chi2)) return std::nullopt;
  return ShapeCost{chi2, static_cast<int>(at.nu_m.size()) - 3};
}

AlongBranch continued_along(const cekf::CompressedEkf& filter, const Branch& branch, const std::vector<LandmarkId>& old,
                            const KeptRemoved& pairs, const SearchOptions& options) {
  AlongBranch along{pairs, 0};
  std::set<LandmarkId> taken;
  for (const auto& [kept, removed] : pairs) taken.insert({kept, removed});
  for (auto id = branch.confirmed.rbegin(); id != branch.confirmed.rend(); ++id) {
    if (along.pairs.size() >= most_pairs) break;
    if (taken.count(*id) > 0 || !filter.contains(*id)) continue;
    const PlacedByOthers place = placed_by_others(filter, along.pairs, *id, options.constellation);
    const std::optional<LandmarkId> partner = nearest_like(filter, branch.appearance, old, taken, place, *id);
    if (!partner) {
      along.alone += branch.old_drive.covers(place.on_map_m) ? 1 : 0;
      continue;
    }
    taken.insert({*partner, *id});
    along.pairs.emplace_back(*partner, *id);
  }
  return along;
}

std::optional<core::ShapeDecision> decided_by_shape(const cekf::CompressedEkf& filter,
                                                    const std::vector<AlongBranch>& places,
                                                    const SearchOptions& options) {
  std::vector<ShapeCost> costs;
  for (const AlongBranch& place : places) {
    const std::optional<ShapeCost> cost = shape_cost(filter, place.pairs, options.merge_sigma_m);
    if (!cost || cost->dof <= 0) return std::nullopt;
    costs.push_back(*cost);
  }
  const auto fits = [&](std::size_t i) {
    return costs[i].chi2 <= core::chi2_quantile(options.closing_probability, costs[i].dof);
  };
  const auto is_refuted = [&](std::size_t i, std::size_t by) {
    constexpr double all_but_never = 1.0 - 1e-6;
    static const double least_nats = std::log(1000.0);
    const bool is_bent = costs[i].chi2 > core::chi2_quantile(all_but_never, costs[i].dof);
    const bool lacks_partners = nats_of_partners(places[i]) + least_nats < nats_of_partners(places[by]);
    return places[i].pairs.size() <= places[by].pairs.size() && (is_bent || lacks_partners);
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    bool is_alone = fits(i);
    for (std::size_t k = 0; is_alone && k < places.size(); ++k) is_alone = k == i || is_refuted(k, i);
    if (is_alone) return decision_for(i, places, costs);
  }
  return std::nullopt;
}

}  // namespace helixnav::supervisor
