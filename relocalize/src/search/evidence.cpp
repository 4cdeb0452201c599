// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "search/hypothesis.hpp"
#include "search/pairing.hpp"

namespace helixnav::relocalize {

namespace {

/// How often a kind or size is wrong altogether; bounds what a single label can say.
constexpr double appearance_error = 0.05;

/// One to one, the likeliest first.
std::vector<Match> one_to_one(const Prepared& asked, const core::Pose2& T) {
  std::vector<Pairable> pairables;
  for (std::size_t i = 0; i < asked.points.size(); ++i)
    for_each_pairable(asked, T, i, [&](const Pairable& pairable) { pairables.push_back(pairable); });
  std::sort(pairables.begin(), pairables.end());
  std::vector<Match> matches;
  for (const Pairable& pairable : pairables) {
    const auto shares = [&](const Match& m) {
      return m.point == pairable.match.point || m.slot == pairable.match.slot;
    };
    if (std::none_of(matches.begin(), matches.end(), shares)) matches.push_back(pairable.match);
  }
  return matches;
}

/// ln p(kind, size | the same landmark) − ln p(kind, size | any landmark of the map).
double appearance(const Prepared& asked, const Match& match) {
  const Landmark& seen = asked.question.landmarks[match.point];
  const Trait& known = asked.map.traits[match.slot];
  const Appearances& population = asked.map.appearances;
  double total = 0.0;
  if (seen.kind && known.kind) {
    const double share = population.kind_share(*seen.kind);
    total += std::log((1.0 - appearance_error) * (*seen.kind == *known.kind ? 1.0 / share : 0.0) + appearance_error);
  }
  if (seen.size && known.size_sigma_m > 0.0F) {
    const double own = seen.size->sigma_m * seen.size->sigma_m;
    const auto ln_normal = [](double d, double variance) { return -0.5 * (std::log(variance) + d * d / variance); };
    const double same = ln_normal(seen.size->mean_m - known.size_m, own + known.size_sigma_m * known.size_sigma_m);
    const double chance = ln_normal(seen.size->mean_m - population.size_mean_m(), own + population.size_variance_m2());
    total += std::log((1.0 - appearance_error) * std::exp(same - chance) + appearance_error);
  }
  return total;
}

/// What neither side explains by a pair.
struct Counts {
  int unmatched = 0;  ///< points without a pair, on the map's ground
  int on_ground = 0;  ///< points on the map's ground, paired ones included
  int missed = 0;     ///< landmarks without a pair, on the question's ground
};

/// Ground that the question looked at, placed on the map, without a rim of three pair noises.
class LookedGround {
 public:
  LookedGround(const Prepared& asked, const core::Pose2& T) : map_(asked.map) {
    const double rim_m = 3.0 * map_.options.pair_noise_m;
    const Eigen::Matrix2d turn = core::rotation(T.heading_rad);
    discs_.reserve(asked.looked.size());
    for (const Disc& disc : asked.looked) {
      discs_.push_back({turn * disc.centre_m + T.position_m(), std::max(0.0, disc.radius_m - rim_m)});
    }
  }

  bool holds(const Node& node) const { return is_in_first(discs_.size(), node); }

  int landmarks() const {
    int count = 0;
    for (std::size_t k = 0; k < discs_.size(); ++k) {
      const Eigen::Vector2f centre_m = discs_[k].centre_m.cast<float>();
      const auto radius_m = static_cast<float>(discs_[k].radius_m);
      map_.grid.within(map_.nodes, centre_m.x(), centre_m.y(), radius_m,
                       [&](Slot slot, float) { count += is_in_first(k, map_.nodes[slot]) ? 0 : 1; });
    }
    return count;
  }

 private:
  bool is_in_first(std::size_t discs, const Node& node) const {
    const Eigen::Vector2d at_m(node.x_m, node.y_m);
    return std::any_of(discs_.begin(), discs_.begin() + static_cast<std::ptrdiff_t>(discs), [&](const Disc& disc) {
      return (disc.centre_m - at_m).squaredNorm() <= disc.radius_m * disc.radius_m;
    });
  }

  const MapIndex::Parts& map_;
  std::vector<Disc> discs_;
};

Counts count(const Prepared& asked, const core::Pose2& T, const std::vector<Match>& matches) {
  const LookedGround ground(asked, T);
  std::vector<bool> paired(asked.points.size(), false);
  Counts counts;
  counts.missed = ground.landmarks();
  for (const Match& match : matches) {
    paired[match.point] = true;
    counts.missed -= ground.holds(asked.map.nodes[match.slot]) ? 1 : 0;
  }
  counts.on_ground = static_cast<int>(matches.size());
  for (std::size_t i = 0; i < paired.size(); ++i) {
    if (paired[i]) continue;
    const Eigen::Vector2f at = laid(T, asked.points[i]);
    if (!asked.map.looked.covers(at.x(), at.y())) continue;
    ++counts.unmatched;
    ++counts.on_ground;
  }
  return counts;
}

/// ln of the mean over the shares u (of the question that is old) and d (of the map that is still there), both unknown.
double ln_change(int matched, const Counts& counts) {
  constexpr std::array<double, 4> shares = {0.3, 0.5, 0.7, 0.9};
  std::array<double, shares.size() * shares.size()> terms{};
  std::size_t k = 0;
  for (const double u : shares)
    for (const double d : shares)
      terms[k++] = matched * std::log(d) + counts.unmatched * std::log1p(-u) + counts.missed * std::log1p(-d) +
                   u * counts.on_ground;
  const double largest = *std::max_element(terms.begin(), terms.end());
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum / static_cast<double>(terms.size()));
}

/// ln p(T): uniform over the map's ground and all headings, or the heavy-tailed prior.
double ln_prior(const Prepared& asked, const core::Pose2& T_origin_centre) {
  if (!asked.question.prior) return -asked.ln_poses;
  const Prior& prior = *asked.question.prior;
  Eigen::Vector3d off = asked.T_map_branch(T_origin_centre).vector() - prior.T_map_branch.mean.vector();
  off.z() = core::wrap_to_pi(off.z());
  const Eigen::Matrix3d& P = prior.T_map_branch.covariance;
  const double believed = std::log1p(-prior.epsilon) - 1.5 * std::log(2.0 * core::pi) -
                          0.5 * std::log(P.determinant()) - 0.5 * off.dot(P.inverse() * off);
  const double anywhere = std::log(prior.epsilon) - asked.ln_poses;
  return std::max(believed, anywhere) + std::log1p(std::exp(-std::abs(believed - anywhere)));
}

}  // namespace

Hypothesis weigh(const Prepared& asked, const core::Pose2& T_origin_centre) {
  Hypothesis h;
  h.T_origin_centre = T_origin_centre;
  h.matches = one_to_one(asked, T_origin_centre);
  h.evidence = -std::numeric_limits<double>::infinity();
  if (h.matches.size() < 3) return h;
  for (int round = 0; round < 3; ++round)
    if (!step_pose(asked, h.matches, 0.0, h.T_origin_centre, h.information)) return h;
  const Counts counts = count(asked, h.T_origin_centre, h.matches);
  h.unmatched = counts.unmatched;
  h.missed = counts.missed;
  double pairs = 0.0;
  for (const Match& match : h.matches) {
    const Difference d = difference(asked, h.T_origin_centre, match);
    const double chi2 = d.value_m.dot(d.covariance_m2.inverse() * d.value_m);
    h.chi2 += chi2;
    pairs += appearance(asked, match) - std::log(asked.density_per_m2 * 2.0 * core::pi) -
             0.5 * std::log(d.covariance_m2.determinant()) - 0.5 * chi2;
  }
  const double ln_volume = 1.5 * std::log(2.0 * core::pi) - 0.5 * std::log(h.information.determinant());
  h.evidence =
      pairs + ln_change(static_cast<int>(h.matches.size()), counts) + ln_volume + ln_prior(asked, h.T_origin_centre);
  return h;
}

}  // namespace helixnav::relocalize
