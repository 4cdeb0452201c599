// SPDX-License-Identifier: BSD-3-Clause
#include "slip/slip_decision.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "slip/density_by_pattern.hpp"

namespace helixnav::supervisor {
namespace {

/// A possible place of the vehicle, or "where it was predicted".
struct Hypothesis {
  core::Pose2 T_predicted_here;
  const std::vector<PointPair>& pairs;
};

bool has(const std::vector<PointPair>& pairs, std::size_t seen) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const PointPair& pair) { return pair.seen == seen; });
}

/// How much less the pairs of one place are worth beside another that leaves their observations unpaired: there they
/// are new landmarks, of the pattern of the map or on ground not looked at: ln λ/λ₀ each, if that is denser than what
/// is in no map.
double nats_of_pattern(const SlipQuestion& question, const Hypothesis& one, const Hypothesis& other) {
  const DensityByPattern pattern(question.geometry,
                                 core::compose(other.T_predicted_here, core::inverse(one.T_predicted_here)));
  double nats = 0.0;
  for (const PointPair& pair : one.pairs) {
    if (has(other.pairs, pair.seen)) continue;
    const double per_m2 =
        std::max(pattern.per_m2(question.seen[pair.seen].covariance_m2), question.new_per_m2[pair.seen]);
    nats += std::max(0.0, std::log(per_m2 / question.extraneous_per_m2));
  }
  return nats;
}

Hypothesis hypothesis(const SlipPlace& place) { return {core::Pose2(place.explanation.displacement), place.pairs}; }

core::SlipDecision figures_of(const SlipQuestion& question, const std::vector<SlipPlace>& places,
                              const SlipOptions& options) {
  const SlipPlace& best = places.front();
  const double nats = best.explanation.nats;
  const auto without = [&](const std::vector<PointPair>& pairs) {
    return explain_without_slip(question.geometry, question.seen, pairs, question.nats_a_pair);
  };
  core::SlipDecision figures;
  figures.pairs = static_cast<int>(best.pairs.size());
  figures.pattern_nats = nats_of_pattern(question, hypothesis(best), {core::Pose2(), question.associated});
  figures.nats = nats - without(question.associated) - figures.pattern_nats;
  figures.same_pairs_nats = nats - without(best.pairs);
  figures.rival_nats = nats;  // nothing explained but by chance
  for (const SlipPlace& other : places) {
    if (is_same_place(other.explanation.displacement, best.explanation.displacement, options.distinct_m)) continue;
    const double lead = nats - other.explanation.nats - nats_of_pattern(question, hypothesis(best), hypothesis(other));
    figures.rival_nats = std::min(figures.rival_nats, lead);
  }
  figures.moved_m = best.explanation.displacement.head<2>().norm();
  figures.turned_deg = best.explanation.displacement.z() * 180.0 / core::pi;
  figures.sigma_m = best.explanation.component.sigma_m;
  return figures;
}

bool is_believed(const core::SlipDecision& d, bool tentative, const SlipOptions& options) {
  if (d.same_pairs_nats <= options.same_pairs_nats || d.rival_nats <= options.rival_nats) return false;
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
  const std::vector<SlipPlace> places = slip_places(question.geometry, question.seen, question.nats_a_pair,
                                                    slip_components(options), options.distinct_m, question.reach);
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
