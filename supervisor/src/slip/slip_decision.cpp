// SPDX-License-Identifier: BSD-3-Clause
#include "slip/slip_decision.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include "association/median.hpp"
#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

/// Median displacement of the pairs by the median distance of their landmarks to the nearest other.
double displaced_by_spacing(const SlipQuestion& question, const SlipPlace& place) {
  const std::vector<Eigen::Vector2d>& points_m = question.geometry.points_m;
  const core::Pose2 T_predicted_displaced(place.explanation.displacement);
  std::vector<double> displaced_m;
  std::vector<double> spacing_m;
  for (const PointPair& pair : place.pairs) {
    const Eigen::Vector2d& seen_m = question.seen[pair.seen].point_m;
    displaced_m.push_back((core::transform(T_predicted_displaced, seen_m) - seen_m).norm());
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < points_m.size(); ++l) {
      if (l != pair.landmark) nearest_m = std::min(nearest_m, (points_m[l] - points_m[pair.landmark]).norm());
    }
    spacing_m.push_back(nearest_m);
  }
  return median(std::move(displaced_m)) / median(std::move(spacing_m));
}

core::SlipDecision figures_of(const SlipQuestion& question, const std::vector<SlipPlace>& places,
                              const SlipOptions& options) {
  const SlipPlace& best = places.front();
  const double nats = best.explanation.nats;
  const auto without = [&](const std::vector<PointPair>& pairs) {
    return explain_without_slip(question.geometry, question.seen, pairs, question.nats_a_pair);
  };
  core::SlipDecision figures;
  figures.pairs = static_cast<int>(best.pairs.size());
  figures.nats = nats - without(question.associated);
  figures.same_pairs_nats = nats - without(best.pairs);
  figures.rival_nats = nats;  // nothing explained but by chance
  for (const SlipPlace& other : places) {
    if (is_same_place(other.explanation.displacement, best.explanation.displacement, options.distinct_m)) continue;
    figures.rival_nats = std::min(figures.rival_nats, nats - other.explanation.nats);
    break;
  }
  figures.moved_m = best.explanation.displacement.head<2>().norm();
  figures.turned_deg = best.explanation.displacement.z() * 180.0 / core::pi;
  figures.sigma_m = best.explanation.component.sigma_m;
  figures.displaced = displaced_by_spacing(question, best);
  return figures;
}

bool is_believed(const core::SlipDecision& d, bool tentative, const SlipOptions& options) {
  if (d.same_pairs_nats <= options.same_pairs_nats || d.rival_nats <= options.rival_nats ||
      !(d.displaced < options.most_displaced)) {
    return false;
  }
  if (d.pairs >= options.least_pairs) return d.nats > (tentative ? options.tentative_nats : options.nats);
  return !tentative && d.nats > options.few_pairs_nats;
}

SlipPair pair_at(const SlipQuestion& question, const SlipPlace& place, const PointPair& pair) {
  const PairEquations e(question.geometry, question.seen, {pair}, place.explanation.displacement);
  const Eigen::Vector2d nu = e.nu - e.A * place.explanation.displacement;
  return {question.seen[pair.seen].observation, question.geometry.ids[pair.landmark],
          nu.dot(Eigen::Matrix2d(e.S).inverse() * nu)};
}

}  // namespace

std::optional<Slip> decide_slip(const SlipQuestion& question, const SlipOptions& options) {
  const std::vector<SlipPlace> places =
      slip_places(question.geometry, question.seen, question.nats_a_pair, slip_components(options), options.distinct_m);
  if (places.empty()) return std::nullopt;
  Slip slip;
  slip.figures = figures_of(question, places, options);
  if (!is_believed(slip.figures, question.tentative, options)) return std::nullopt;
  const SlipPlace& place = places.front();
  slip.displacement = place.explanation.displacement;
  slip.covariance = place.explanation.component.covariance();
  for (const PointPair& pair : place.pairs) slip.pairs.push_back(pair_at(question, place, pair));
  return slip;
}

}  // namespace helixnav::supervisor
