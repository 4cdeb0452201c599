// SPDX-License-Identifier: BSD-3-Clause
#include "slip/slip_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double same_heading_rad = 2.0 * core::pi / 180.0;
constexpr double reach_sigmas = 2.5;  // of the widest component
constexpr double neighbours = 1.25;   // within how many spacings rivals are looked for
constexpr double pair_gate_probability = 0.999;
constexpr std::size_t least_pairs_of_slip = 3;
constexpr std::size_t most_refined = 8;
constexpr int rounds = 3;

/// A displacement with its covariance and the pairs within the gate there; nats without the pairs' correlations.
struct Proposal {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  std::vector<PointPair> pairs;
  double nats = 0.0;
};

class Proposer {
 public:
  Proposer(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen, double nats_a_pair,
           const SlipComponent& widest, SlipReach reach)
      : geometry_(geometry),
        seen_(seen),
        nats_a_pair_(nats_a_pair),
        widest_(widest),
        in_reach_(landmarks_in_reach(spacing_in(reach, geometry.points_m))) {}

  std::vector<Proposal> proposals() const {
    std::vector<Proposal> found;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      for (std::size_t k = i + 1; k < seen_.size(); ++k) propose_by(i, k, found);
    }
    return found;
  }

  /// Nearest first, one to one, with the vehicle displaced like that.
  Proposal pair_up(const Eigen::Vector3d& displacement, const Eigen::Matrix3d& covariance) const {
    static const double gate = core::chi2_quantile(pair_gate_probability, 2);
    std::vector<Candidate> candidates;
    const Eigen::Matrix2d turn = core::rotation(-displacement.z());
    for (std::size_t s = 0; s < seen_.size(); ++s) {
      for (const std::size_t l : in_reach_[s]) {
        const Candidate one = weigh({s, l}, turn, displacement, covariance, gate);
        if (one.nis < gate && one.nats > 0.0) candidates.push_back(one);
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.nis < b.nis; });
    Proposal proposal{displacement, {}, 0.0};
    for (const Candidate& one : candidates) {
      const bool taken = std::any_of(proposal.pairs.begin(), proposal.pairs.end(), [&](const PointPair& pair) {
        return pair.seen == one.pair.seen || pair.landmark == one.pair.landmark;
      });
      if (taken) continue;
      proposal.pairs.push_back(one.pair);
      proposal.nats += one.nats;
    }
    return proposal;
  }

 private:
  struct Candidate {
    PointPair pair;
    double nis;
    double nats;
  };

  std::vector<std::vector<std::size_t>> landmarks_in_reach(double spacing_m) const {
    std::vector<std::vector<std::size_t>> in_reach(seen_.size());
    for (std::size_t s = 0; s < seen_.size(); ++s) {
      const double reach_m = slip_reach_m(widest_, seen_[s], spacing_m);
      for (std::size_t l = 0; l < geometry_.points_m.size(); ++l) {
        if ((geometry_.points_m[l] - seen_[s].point_m).norm() < reach_m) in_reach[s].push_back(l);
      }
    }
    return in_reach;
  }

  void propose_by(std::size_t i, std::size_t k, std::vector<Proposal>& found) const {
    for (const std::size_t a : in_reach_[i]) {
      for (const std::size_t b : in_reach_[k]) {
        if (a == b || !is_equally_far(i, k, a, b)) continue;
        const Eigen::Vector3d displacement = rigid_displacement(i, k, a, b);
        if (!is_in_reach(displacement)) continue;
        Proposal one = pair_up(displacement, covariance_by({i, a}, {k, b}, displacement));
        if (one.pairs.size() >= least_pairs_of_slip) found.push_back(std::move(one));
      }
    }
  }

  bool is_equally_far(std::size_t i, std::size_t k, std::size_t a, std::size_t b) const {
    static const double gate = core::chi2_quantile(pair_gate_probability, 1);
    const Eigen::Vector2d way_m = seen_[k].point_m - seen_[i].point_m;
    const Eigen::Vector2d map_way_m = geometry_.points_m[b] - geometry_.points_m[a];
    const Eigen::Vector2d u = map_way_m.normalized();
    const Eigen::Matrix2d noise = seen_[i].covariance_m2 + seen_[k].covariance_m2 + geometry_.covariance_of(a, a) +
                                  geometry_.covariance_of(b, b) - geometry_.covariance_of(a, b) -
                                  geometry_.covariance_of(b, a);
    const double difference_m = map_way_m.norm() - way_m.norm();
    return difference_m * difference_m < gate * u.dot(noise * u);
  }

  Eigen::Vector3d rigid_displacement(std::size_t i, std::size_t k, std::size_t a, std::size_t b) const {
    const Eigen::Vector2d way_m = seen_[k].point_m - seen_[i].point_m;
    const Eigen::Vector2d map_way_m = geometry_.points_m[b] - geometry_.points_m[a];
    const double turn_rad =
        core::wrap_to_pi(std::atan2(map_way_m.y(), map_way_m.x()) - std::atan2(way_m.y(), way_m.x()));
    const Eigen::Vector2d middle_m = 0.5 * (seen_[i].point_m + seen_[k].point_m);
    const Eigen::Vector2d map_middle_m = 0.5 * (geometry_.points_m[a] + geometry_.points_m[b]);
    Eigen::Vector3d displacement;
    displacement << map_middle_m - core::rotation(turn_rad) * middle_m, turn_rad;
    return displacement;
  }

  bool is_in_reach(const Eigen::Vector3d& displacement) const {
    return displacement.head<2>().norm() < reach_sigmas * widest_.sigma_m &&
           std::abs(displacement.z()) < reach_sigmas * widest_.sigma_rad;
  }

  Eigen::Matrix2d spread(const PointPair& pair, const Eigen::Matrix2d& turn) const {
    return seen_[pair.seen].covariance_m2 +
           turn * geometry_.covariance_of(pair.landmark, pair.landmark) * turn.transpose();
  }

  Eigen::Vector2d expected_m(const PointPair& pair, const Eigen::Matrix2d& turn, const Eigen::Vector3d& at) const {
    return turn * (geometry_.points_m[pair.landmark] - at.head<2>());
  }

  static Eigen::Matrix<double, 2, 3> by_displacement(const Eigen::Vector2d& expected_m, const Eigen::Matrix2d& turn) {
    Eigen::Matrix<double, 2, 3> A;
    A << -turn, Eigen::Vector2d(expected_m.y(), -expected_m.x());
    return A;
  }

  /// Covariance of a displacement given by two pairs.
  Eigen::Matrix3d covariance_by(const PointPair& first, const PointPair& second, const Eigen::Vector3d& at) const {
    const Eigen::Matrix2d turn = core::rotation(-at.z());
    Eigen::Matrix3d information = widest_.covariance().inverse();
    for (const PointPair& pair : {first, second}) {
      const Eigen::Matrix<double, 2, 3> A = by_displacement(expected_m(pair, turn, at), turn);
      information += A.transpose() * spread(pair, turn).inverse() * A;
    }
    return information.inverse();
  }

  /// Beyond the gate for sure: no direction of S has more variance than its trace, in which (a + b)² counts as 2a² + 2b².
  bool is_far(const PointPair& pair, const Eigen::Vector2d& nu_m, double range2_m2, const Eigen::Matrix3d& covariance,
              double gate) const {
    const double turning_m2 = range2_m2 * covariance(2, 2);
    const double most_m2 = seen_[pair.seen].covariance_m2.trace() +
                           geometry_.covariance_of(pair.landmark, pair.landmark).trace() +
                           2.0 * (covariance(0, 0) + covariance(1, 1) + turning_m2);
    return nu_m.squaredNorm() > gate * most_m2;
  }

  Candidate weigh(const PointPair& pair, const Eigen::Matrix2d& turn, const Eigen::Vector3d& at,
                  const Eigen::Matrix3d& covariance, double gate) const {
    const Eigen::Vector2d expected = expected_m(pair, turn, at);
    if (is_far(pair, seen_[pair.seen].point_m - expected, expected.squaredNorm(), covariance, gate))
      return {pair, gate, 0.0};
    const Eigen::Matrix<double, 2, 3> A = by_displacement(expected, turn);
    const Eigen::Matrix2d S = spread(pair, turn) + A * covariance * A.transpose();
    const Eigen::Vector2d nu = seen_[pair.seen].point_m - expected;
    const double nis = nu.dot(S.inverse() * nu);
    return {pair, nis, nats_a_pair_ - 0.5 * (nis + std::log(S.determinant())) - std::log(2.0 * core::pi)};
  }

  const RelativeGeometry& geometry_;
  const std::vector<SeenPoint>& seen_;
  double nats_a_pair_;
  const SlipComponent& widest_;
  std::vector<std::vector<std::size_t>> in_reach_;
};

/// At least half of the pairs of `one` are pairs of the other: weighed again from there, it would settle on the same.
bool pairs_alike(const std::vector<PointPair>& one, const std::vector<PointPair>& other) {
  const auto shared = std::count_if(one.begin(), one.end(), [&](const PointPair& a) {
    return std::any_of(other.begin(), other.end(),
                       [&](const PointPair& b) { return a.seen == b.seen && a.landmark == b.landmark; });
  });
  return 2 * static_cast<std::size_t>(shared) >= one.size();
}

std::vector<Proposal> best_distinct(std::vector<Proposal> proposals, double distinct_m) {
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.nats > b.nats; });
  std::vector<Proposal> best;
  for (Proposal& one : proposals) {
    if (best.size() >= most_refined) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const Proposal& other) {
      return is_same_place(other.displacement, one.displacement, distinct_m) || pairs_alike(one.pairs, other.pairs);
    });
    if (!known) best.push_back(std::move(one));
  }
  return best;
}

}  // namespace

double spacing_in(SlipReach reach, const std::vector<Eigen::Vector2d>& points_m) {
  return reach == SlipReach::next_neighbour ? median_spacing_m(points_m) : std::numeric_limits<double>::infinity();
}

double slip_reach_m(const SlipComponent& widest, const SeenPoint& seen, double spacing_m) {
  return std::min(neighbours * spacing_m, reach_sigmas * (widest.sigma_m + widest.sigma_rad * seen.point_m.norm()));
}

bool is_same_place(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double distinct_m) {
  return (a - b).head<2>().norm() < distinct_m && std::abs(core::wrap_to_pi(a.z() - b.z())) < same_heading_rad;
}

std::vector<SlipPlace> slip_places(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                                   double nats_a_pair, const std::vector<SlipComponent>& components, double distinct_m,
                                   SlipReach reach) {
  const Proposer proposer(geometry, seen, nats_a_pair, components.back(), reach);
  std::vector<SlipPlace> places;
  for (Proposal& proposal : best_distinct(proposer.proposals(), distinct_m)) {
    SlipPlace place{std::move(proposal.pairs), {}};
    place.explanation.displacement = proposal.displacement;
    for (int round = 0; round < rounds && place.pairs.size() >= least_pairs_of_slip; ++round) {
      place.explanation =
          explain_by_slip(geometry, seen, place.pairs, nats_a_pair, components, place.explanation.displacement);
      if (round + 1 == rounds) break;
      place.pairs = proposer.pair_up(place.explanation.displacement, place.explanation.displacement_covariance).pairs;
    }
    if (place.pairs.size() >= least_pairs_of_slip) places.push_back(std::move(place));
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const SlipPlace& a, const SlipPlace& b) { return a.explanation.nats > b.explanation.nats; });
  return places;
}

}  // namespace helixnav::supervisor
