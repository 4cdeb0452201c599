// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/ask.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "search/places.hpp"
#include "search/residual_scale.hpp"

namespace helixnav::relocalize {

namespace {

constexpr std::size_t least_pairs = 5;
constexpr std::size_t enough_triangles = 100;  ///< a search capped before may have missed a rival

Place place_of(const Prepared& asked, const Hypothesis& h) {
  Place place;
  place.T_map_branch = asked.T_map_branch(h.T_origin_centre);
  // The centre's pose is T_map_branch with the lever arm from the branch's origin to the centre.
  Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
  lever.topRightCorner<2, 1>() =
      core::rotation(h.T_origin_centre.heading_rad) * Eigen::Vector2d(-asked.centre_m.y(), asked.centre_m.x());
  place.information = lever.transpose() * h.information * lever;
  for (const Match& match : h.matches)
    place.pairs.push_back({asked.question.landmarks[match.point].id, asked.map.details[match.slot].id});
  place.chi2 = h.chi2;
  place.evidence = h.evidence;
  place.unmatched = h.unmatched;
  place.missed = h.missed;
  return place;
}

/// How much evidence rivals have by chance: their mean excess over the twentieth place, or over nothing; two of 1 nat are
/// taken as seen.
struct RivalScale {
  double mean = 1.0;
  double known_from = 0.0;  ///< rivals; 0 where places do not look alike and theory says 1

  /// −ln of the probability that chance leads by this much. A mean that was itself estimated from k exponential rivals makes
  /// it (1 + lead / (k·mean))^−k in place of an exponential.
  double score(double lead) const {
    return known_from > 0.0 ? known_from * std::log1p(lead / (known_from * mean)) : lead / mean;
  }
};

RivalScale rival_scale(const std::vector<Place>& places) {
  const bool full = places.size() == most_places;
  const double floor = full ? std::max(0.0, places.back().evidence) : 0.0;
  double sum = 2.0;
  double count = 2.0;
  for (std::size_t i = 1; i + (full ? 1 : 0) < places.size(); ++i) {
    if (places[i].evidence <= floor) continue;
    sum += places[i].evidence - floor;
    ++count;
  }
  return {std::max(1.0, sum / count), floor > 0.0 ? count : 0.0};
}

/// Lead of the first place over the others, in nats of chance.
double lead(const std::vector<Place>& places, double least_rival) {
  const double rival = places.size() > 1 ? places[1].evidence : 0.0;
  return rival_scale(places).score(places.front().evidence - std::max({0.0, least_rival, rival}));
}

/// How many poses on the map's ground the pairs of a place can tell apart, as ln.
double ln_poses_apart(const Prepared& asked, const Place& place) {
  return asked.ln_poses + 0.5 * std::log(place.information.determinant()) - 1.5 * std::log(2.0 * core::pi);
}

/// A wrong place fits like other wrong ones: in an avenue, all of them to within the jitter of its trees. The first place without
/// those rivals whose residuals are of another scale, so that, if it were one of them, it would not fit so much better at any
/// of all poses.
std::vector<Place> without_other_scales(const std::vector<Place>& places, double least_ln_chance) {
  const auto residuals = [](const Place& place) {
    constexpr double fixed_by_pose = 3.0;
    return Residuals{place.chi2, 2.0 * static_cast<double>(place.pairs.size()) - fixed_by_pose};
  };
  std::vector<Place> left;
  for (const Place& place : places) {
    const double ln_chance = ln_chance_of_smaller(residuals(places.front()), residuals(place));
    if (left.empty() || ln_chance > least_ln_chance) left.push_back(place);
  }
  return left;
}

/// As it is with all rivals, or without those of another scale. Rivals that are not listed have no more evidence than the last of
/// a full list.
double gap(const Prepared& asked, const std::vector<Place>& places, const AskOptions& options) {
  const double with_all = lead(places, 0.0);
  const double least_ln_chance = std::log(options.alpha) - ln_poses_apart(asked, places.front());
  const std::vector<Place> left = without_other_scales(places, least_ln_chance);
  if (left.size() == places.size()) return with_all;
  return std::max(with_all, lead(left, places.size() == most_places ? places.back().evidence : 0.0));
}

Verdict decide(const Answer& answer, const AskOptions& options) {
  if (answer.places.empty()) return Verdict::not_here;
  const Place& best = answer.places.front();
  if (best.evidence < evidence_needed(options) || best.pairs.size() < least_pairs) return Verdict::not_here;
  const bool cut_short = answer.crowded || (answer.capped && answer.triangles < enough_triangles);
  return cut_short || answer.gap < -std::log(options.alpha) ? Verdict::ambiguous : Verdict::closed;
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::closed:
      return "closed";
    case Verdict::ambiguous:
      return "ambiguous";
    default:
      return "not here";
  }
}

double evidence_needed(const AskOptions& options) { return std::log(options.evidence_density / options.alpha); }

Answer ask(const MapIndex& map, const Question& question, const AskOptions& options) {
  if (!(options.alpha > 0.0 && options.alpha < 1.0)) throw core::PreconditionError("ask: alpha is not in (0, 1)");
  if (!(options.evidence_density > 0.0 && options.evidence_density <= 1.0)) {
    throw core::PreconditionError("ask: evidence_density is not in (0, 1]");
  }
  const Prepared asked(map.parts(), question);
  Answer answer;
  if (asked.points.size() < 4 || map.size() < 4) return answer;
  const Candidates candidates = find_candidates(asked, options.most_candidates);
  answer.triangles = candidates.triangles;
  answer.candidates = candidates.looked_at;
  answer.capped = candidates.capped;
  answer.crowded = candidates.crowded;
  for (const Hypothesis& h : find_places(asked, candidates.best)) answer.places.push_back(place_of(asked, h));
  if (answer.places.empty()) return answer;
  answer.rival_scale = rival_scale(answer.places).mean;
  answer.gap = gap(asked, answer.places, options);
  answer.verdict = decide(answer, options);
  return answer;
}

}  // namespace helixnav::relocalize
