// SPDX-License-Identifier: BSD-3-Clause
#include "association/place_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "association/candidates.hpp"
#include "association/median.hpp"
#include "association/old_pairs.hpp"
#include "association/revisit_ambiguity.hpp"
#include "association/rival_matchings.hpp"
#include "helixnav/association/likelihood_ratio.hpp"

namespace helixnav::supervisor {
namespace {

using association::Assignment;
using association::GatedPair;
using association::InnovationProblem;
using core::LandmarkId;

/// ln(e^a + e^b).
double add_exponents(double a, double b) {
  const double greater = std::max(a, b);
  return std::isinf(greater) ? greater : greater + std::log1p(std::exp(std::min(a, b) - greater));
}

/// One question about one scan: which of its matches are old, and which are given.
class Question {
 public:
  Question(const cekf::CompressedEkf& filter, const InnovationProblem& problem, const Assignment& assignment,
           const core::Scan& scan, const std::vector<LandmarkId>& old)
      : filter_(filter), problem_(problem), scan_(scan), old_(old), taken_(problem.observations.size(), false) {
    for (const int p : assignment.pairs) {
      const GatedPair& pair = pair_at(p);
      if (is_old(pair)) {
        matched_.push_back(p);
        continue;
      }
      taken_[static_cast<std::size_t>(pair.observation)] = true;
      constexpr std::size_t enough = 8;  // to fix the pose as far as recent landmarks can
      if (given_.size() < enough) given_.push_back(p);
    }
  }

  int matched() const { return static_cast<int>(matched_.size()); }

  /// widening, width_m and spacing_m.
  PlaceEvidence widths() const {
    PlaceEvidence place;
    std::vector<double> widenings, widths_m;
    for (const int p : matched_) {
      const double det_S = old_pairs_given(problem_, {p}, given_).S.determinant();
      const association::Prediction& prediction = problem_.predictions[static_cast<std::size_t>(pair_at(p).prediction)];
      const bool polar = prediction.kind == core::ObservationKind::range_bearing;
      const core::ObsMatrix& R = scan_.observations[static_cast<std::size_t>(pair_at(p).observation)].R;
      widenings.push_back(std::sqrt(det_S / Eigen::Matrix2d(R).determinant()));
      widths_m.push_back(std::sqrt(std::sqrt(det_S) * (polar ? prediction.z_hat.x() : 1.0)));
    }
    place.pairs = matched();
    place.widening = median(std::move(widenings));
    place.width_m = median(std::move(widths_m));
    place.spacing_m = spacing_m();
    return place;
  }

  /// The loose ones (fixes_pose) in the half of the matches that is known least well.
  std::vector<LandmarkId> loose(double extraneous_per_scan, double defer_confusers) const {
    const OldPairs pairs = old_pairs_given(problem_, matched_, given_);
    const auto may_be = [&](int k, const Eigen::Matrix2d& S) {
      return extraneous_in_gate(problem_, pairs.at(k), S, scan_, extraneous_per_scan) > defer_confusers;
    };
    std::vector<int> by_width(matched_.size());
    std::iota(by_width.begin(), by_width.end(), 0);
    std::sort(by_width.begin(), by_width.end(), [&](int k, int l) { return widening(pairs, k) < widening(pairs, l); });
    const auto half = by_width.begin() + static_cast<std::ptrdiff_t>((by_width.size() + 1) / 2);
    std::vector<int> best = given_;
    std::transform(by_width.begin(), half, std::back_inserter(best), [&](int k) { return matched_[at(k)]; });
    std::vector<LandmarkId> loose;
    for (auto k = half; k != by_width.end(); ++k) {
      if (!may_be(*k, pairs.covariance(*k, *k))) continue;  // given more, its gate is smaller still
      if (may_be(*k, old_pairs_given(problem_, {matched_[at(*k)]}, best).S)) loose.push_back(landmark(pairs.at(*k)));
    }
    std::sort(loose.begin(), loose.end());
    return loose;
  }

  /// Old landmarks that should be in view but that the assignment does not match.
  int missing(double view_margin_m) const {
    std::vector<LandmarkId> met;
    for (const int p : matched_) met.push_back(landmark(pair_at(p)));
    const std::vector<LandmarkId> expected = expected_in_view(filter_, scan_, view_margin_m);
    return static_cast<int>(std::count_if(expected.begin(), expected.end(), [&](LandmarkId id) {
      return is_old(id) && std::find(met.begin(), met.end(), id) == met.end();
    }));
  }

  double wrong_probability(double extraneous_per_scan, int missing, const SearchOptions& options) const {
    const OldPairs pairs = old_pairs_given(problem_, gated_with_old(), given_);
    Matching best;
    for (int k = 0; k < pairs.size(); ++k) {
      const int p = pairs.pair[static_cast<std::size_t>(k)];
      if (std::binary_search(matched_.begin(), matched_.end(), p)) best.push_back(k);
    }
    const auto rivals = rival_matchings(pairs, best);
    if (!rivals) return 1.0;
    const double missing_nats = options.integrity.missing_nats * missing;
    const association::ExtraneousDensity extraneous = association::density_in_view(scan_, extraneous_per_scan, {});
    const auto evidence = [&](const Matching& matching) {
      double nats = joint_log_likelihood(pairs, matching) - missing_nats;
      const double detected = 1.0 - std::exp(-options.integrity.missing_nats);
      for (const int k : matching) {
        nats += std::log(detected /
                         extraneous.of(problem_.observations[static_cast<std::size_t>(pairs.at(k).observation)].kind)) +
                pairs.at(k).appearance_nats;
      }
      return nats;
    };
    double others = 0.0;
    for (const Matching& rival : *rivals) others = add_exponents(others, evidence(rival));
    return std::exp(others - add_exponents(others, evidence(best)));
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  double widening(const OldPairs& pairs, int k) const {
    const core::ObsMatrix& R = scan_.observations[at(pairs.at(k).observation)].R;
    return std::sqrt(pairs.covariance(k, k).determinant() / Eigen::Matrix2d(R).determinant());
  }
  const GatedPair& pair_at(int p) const { return problem_.pairs[static_cast<std::size_t>(p)]; }
  LandmarkId landmark(const GatedPair& pair) const { return problem_.ids[static_cast<std::size_t>(pair.candidate)]; }
  bool is_old(LandmarkId id) const { return std::binary_search(old_.begin(), old_.end(), id); }
  bool is_old(const GatedPair& pair) const { return is_old(landmark(pair)); }

  /// All pairs of old landmarks with observations that nothing else explains.
  std::vector<int> gated_with_old() const {
    std::vector<int> pairs;
    for (std::size_t p = 0; p < problem_.pairs.size(); ++p) {
      const GatedPair& pair = problem_.pairs[p];
      const bool free = !taken_[static_cast<std::size_t>(pair.observation)];
      if (pair.dof == 2 && free && is_old(pair)) pairs.push_back(static_cast<int>(p));
    }
    return pairs;
  }

  double spacing_m() const {
    const Eigen::Vector2d sensor_m = core::transform(filter_.pose().mean, scan_.T_robot_sensor.position_m());
    std::vector<Eigen::Vector2d> points_m;
    for (const LandmarkId id : filter_.landmarks_within(sensor_m, scan_.field_of_view.max_range_m)) {
      if (is_old(id)) points_m.push_back(filter_.landmark_mean(id));
    }
    if (points_m.size() < 2) return 0.0;
    std::vector<double> nearest_m;
    for (const Eigen::Vector2d& point_m : points_m) {
      double nearest2 = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector2d& other_m : points_m) {
        if (&other_m != &point_m) nearest2 = std::min(nearest2, (other_m - point_m).squaredNorm());
      }
      nearest_m.push_back(std::sqrt(nearest2));
    }
    return median(std::move(nearest_m));
  }

  const cekf::CompressedEkf& filter_;
  const InnovationProblem& problem_;
  const core::Scan& scan_;
  const std::vector<LandmarkId>& old_;
  std::vector<int> matched_;  ///< pairs of the assignment with old landmarks
  std::vector<int> given_;    ///< and with others
  std::vector<bool> taken_;   ///< observations that the others explain
};

bool adds_little(const PlaceEvidence& place, const SearchOptions& options) {
  return place.pairs > 0 && place.widening <= options.confirmation_widening;
}

bool leaves_no_room(const PlaceEvidence& place) { return 2.0 * place.width_m < 0.5 * place.spacing_m; }

}  // namespace

PlaceEvidence place_evidence(const cekf::CompressedEkf& filter, const InnovationProblem& problem,
                             const Assignment& assignment, const core::Scan& scan, const std::vector<LandmarkId>& old,
                             double extraneous_per_scan, double view_margin_m, const SearchOptions& options) {
  const Question question(filter, problem, assignment, scan, old);
  if (question.matched() == 0) return {};
  PlaceEvidence place = question.widths();
  if (!adds_little(place, options) && !leaves_no_room(place)) return place;  // the rest decides nothing
  place.loose = question.loose(extraneous_per_scan, options.defer_confusers);
  if (adds_little(place, options)) return place;
  place.met = static_cast<int>(assignment.pairs.size());
  place.missing = question.missing(view_margin_m);
  place.wrong_probability = question.wrong_probability(extraneous_per_scan, place.missing, options);
  return place;
}

bool fixes_pose(const PlaceEvidence& place, const SearchOptions& options) {
  if (place.loose.size() > 1) return false;
  return adds_little(place, options) ||
         (leaves_no_room(place) && place.wrong_probability < options.wrong_place_probability);
}

bool leaves_one_place(const PlaceEvidence& place, const SearchOptions& options) {
  if (place.pairs == 0 || place.loose.size() > 1 || !leaves_no_room(place)) return false;
  return options.integrity.missing_nats * place.missing <= options.integrity.seen_nats * place.met;
}

}  // namespace helixnav::supervisor
