// SPDX-License-Identifier: BSD-3-Clause
#include "associate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helixnav::fastslam {
namespace {

constexpr double log_two_pi = 1.8378770664093453;

/// H P Hᵀ.
Symmetric2 sandwich(const Eigen::Matrix2d& H, const Symmetric2& P) {
  const double a = H(0, 0) * P.xx + H(0, 1) * P.xy, b = H(0, 0) * P.xy + H(0, 1) * P.yy;
  const double c = H(1, 0) * P.xx + H(1, 1) * P.xy, d = H(1, 0) * P.xy + H(1, 1) * P.yy;
  return {a * H(0, 0) + b * H(0, 1), a * H(1, 0) + b * H(1, 1), c * H(1, 0) + d * H(1, 1)};
}

}  // namespace

Associator::Associator(const Options& options, const PreparedScan& scan, const Lineages& lineages,
                       const std::vector<PersistentMap>& maps)
    : options_(options),
      scan_(scan),
      lineages_(lineages),
      maps_(maps),
      view_(scan.view, 1.0, 0.0),
      log_detection_odds_(std::log(options.detection_probability / (1.0 - options.detection_probability))),
      log_unmatched_(std::log(options.new_density + options.clutter_density)),
      log_new_(std::log(options.new_density)),
      log_clutter_(std::log(options.clutter_density)),
      log_missed_(std::log1p(-options.detection_probability)) {}

double Associator::spread_m2(const Hypothesis& h, const PreparedObservation& z) const {
  return z.noise_m2 + h.P(0, 0) + h.P(1, 1) + z.arm_m * z.arm_m * h.P(2, 2);
}

void Associator::look_around(const HypothesisSet& set, std::size_t begin, std::size_t end, std::size_t only,
                             AssociationScratch& scratch) const {
  const PreparedObservation& z = scan_.observations[only];
  Eigen::Vector2d low = Eigen::Vector2d::Constant(HUGE_VAL), high = -low;
  double spread = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector2d place_m = set.all[i].pose.place(z.point_robot_m);
    low = low.cwiseMin(place_m);
    high = high.cwiseMax(place_m);
    spread = std::max(spread, spread_m2(set.all[i], z));
  }
  // Matches move a hypothesis while its candidates are being sought: by what its own spread allows.
  const double moves_m = 3.0 * std::sqrt(std::max(0.0, spread - z.noise_m2));  // rounding of a certain pose
  const double margin_m = moves_m + std::sqrt(search_slack * std::max(options_.match_gate, options_.new_gate) * spread);
  if (scratch.near.size() <= only) scratch.near.resize(only + 1);
  neighbours(low, high, margin_m, scratch.near[only]);
}

/// Lineages near a rectangle, by id.
std::vector<Neighbour>& Associator::neighbours(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m,
                                               double margin_m, std::vector<Neighbour>& out) const {
  out.clear();
  lineages_.visit(low_m, high_m, margin_m, [&](LineageId id) {
    out.push_back({id, static_cast<float>(lineages_.reach_m(id)), lineages_.anchor_m(id)});
  });
  std::sort(out.begin(), out.end(), [](const Neighbour& a, const Neighbour& b) { return a.id < b.id; });
  return out;
}

void Associator::look_around(const HypothesisSet& set, std::size_t begin, std::size_t end,
                             AssociationScratch& scratch) const {
  for (std::size_t j = 0; j < scan_.observations.size(); ++j) look_around(set, begin, end, j, scratch);
  scratch.in_reach.clear();
  if (!options_.weigh_unseen || !view_.bounded()) return;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(HUGE_VAL), high = -low;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector2d sensor_m = set.all[i].pose.place(scan_.sensor_robot_m);
    low = low.cwiseMin(sensor_m);
    high = high.cwiseMax(sensor_m);
  }
  neighbours(low, high, scan_.view.max_range_m, scratch.in_reach);
}

void Associator::weigh_view(Hypothesis& h, const AssociationScratch& scratch) const {
  if (scratch.in_reach.empty()) return;
  const PersistentMap& map = maps_[h.parent];
  int in_view = 0;
  for (const Neighbour& n : scratch.in_reach) {
    const LandmarkRecord* landmark = map.find(n.id);
    if (landmark == nullptr) continue;
    const Eigen::Vector2d place_m = n.anchor_m + Eigen::Vector2d(landmark->dx_m, landmark->dy_m);
    const Eigen::Vector2d at_m = in_sensor(scan_, h.pose, place_m);
    in_view += view_.sees(at_m.x(), at_m.y());
  }
  h.log_weight += in_view * log_missed_;
}

Associator::Innovation Associator::innovation(const Hypothesis& h, const Eigen::Vector2d& landmark_m,
                                              const Symmetric2& landmark_m2, const PreparedObservation& z) const {
  Innovation out;
  out.pair = compare(scan_, z, h.pose, landmark_m);
  out.S = sandwich(out.pair.H_point, landmark_m2);
  out.S.xx += z.R(0, 0), out.S.xy += z.R(0, 1), out.S.yy += z.R(1, 1);
  if (options_.proposal == Proposal::motion_and_scan) {
    const Matrix23 HP = out.pair.H_pose * h.P;
    out.S.xx += HP.row(0).dot(out.pair.H_pose.row(0));
    out.S.xy += HP.row(0).dot(out.pair.H_pose.row(1));
    out.S.yy += HP.row(1).dot(out.pair.H_pose.row(1));
  }
  const double a = out.pair.nu.x(), b = out.pair.nu.y();
  out.determinant = out.S.xx * out.S.yy - out.S.xy * out.S.xy;
  out.nis = (out.S.yy * a * a - 2.0 * out.S.xy * a * b + out.S.xx * b * b) / out.determinant;
  return out;
}

double Associator::nis(const Hypothesis& h, LineageId id, std::size_t observation) const {
  const LandmarkRecord* landmark = maps_[h.parent].find(id);
  const Innovation i =
      innovation(h, place_m(id, *landmark), landmark->covariance_m2(), scan_.observations[observation]);
  return i.can_be_told() ? i.nis : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector2d Associator::normalised_innovation(const Hypothesis& h, LineageId id, std::size_t observation) const {
  const LandmarkRecord* landmark = maps_[h.parent].find(id);
  const Innovation i =
      innovation(h, place_m(id, *landmark), landmark->covariance_m2(), scan_.observations[observation]);
  return {i.pair.nu.x() / std::sqrt(i.S.xx), i.pair.nu.y() / std::sqrt(i.S.yy)};
}

void Associator::find_candidates(const Hypothesis& h, std::size_t observation, double gate, bool likelihood,
                                 AssociationScratch& scratch) const {
  const PreparedObservation& z = scan_.observations[observation];
  const PersistentMap& map = maps_[h.parent];
  const Eigen::Vector2d seen_m = h.pose.place(z.point_robot_m);
  const double spread = spread_m2(h, z), slack_gate = search_slack * gate, far_m = std::sqrt(slack_gate * spread);
  scratch.candidates.clear();
  for (const Neighbour& n : scratch.near[observation]) {
    const double within_m = far_m + static_cast<double>(n.reach_m);
    if ((n.anchor_m - seen_m).squaredNorm() > within_m * within_m) continue;
    const LandmarkRecord* landmark = map.find(n.id);
    if (landmark == nullptr) continue;
    const Eigen::Vector2d at_m = n.anchor_m + Eigen::Vector2d(landmark->dx_m, landmark->dy_m);
    const Symmetric2 P = landmark->covariance_m2();
    if ((at_m - seen_m).squaredNorm() > slack_gate * (spread + P.trace())) continue;
    const Innovation i = innovation(h, at_m, P, z);
    if (!i.can_be_told() || i.nis > gate) continue;
    const double log_likelihood = likelihood ? -0.5 * (i.nis + std::log(i.determinant)) - log_two_pi : 0.0;
    scratch.candidates.push_back({n.id, static_cast<std::uint32_t>(observation), i.nis, log_likelihood});
  }
}

void Associator::take(Hypothesis& h, const Candidate& candidate, bool known) const {
  const bool moves = options_.proposal == Proposal::motion_and_scan;
  if (!moves && !known && options_.association != Association::nearest_neighbour) {
    h.log_weight += candidate.log_likelihood + log_detection_odds_;  // nothing has moved since it was found
    return;
  }
  const LandmarkRecord& landmark = *maps_[h.parent].find(candidate.id);
  const Innovation i = innovation(h, place_m(candidate.id, landmark), landmark.covariance_m2(),
                                  scan_.observations[candidate.observation]);
  if (!i.can_be_told()) {
    h.log_weight = -HUGE_VAL;  // the pose stays as it was
    return;
  }
  h.log_weight += -0.5 * (i.nis + std::log(i.determinant)) - log_two_pi;
  if (!known) h.log_weight += log_detection_odds_;
  if (!moves) return;
  Eigen::Matrix2d S_inverse;
  S_inverse << i.S.yy, -i.S.xy, -i.S.xy, i.S.xx;
  S_inverse /= i.determinant;
  const Eigen::Matrix<double, 3, 2> PHt = h.P * i.pair.H_pose.transpose(), K = PHt * S_inverse;
  h.x += K * i.pair.nu;
  h.pose = TurnedPose(h.x);
  h.P -= K * PHt.transpose();
  h.P = 0.5 * (h.P + h.P.transpose()).eval();
}

void Associator::associate_known(Hypothesis& h, Choice* choices, const std::vector<Choice>& known) const {
  for (std::size_t j = 0; j < known.size(); ++j) {
    choices[j] = known[j];
    if (known[j] < 0) continue;
    const auto id = static_cast<LineageId>(known[j]);
    if (maps_[h.parent].find(id) == nullptr) {
      choices[j] = begins_landmark;
    } else {
      take(h, {id, static_cast<std::uint32_t>(j), 0.0, 0.0}, true);
    }
  }
}

bool Associator::is_taken(const Choice* choices, LineageId id) const {
  for (std::size_t j = 0; j < scan_.observations.size(); ++j) {
    if (choices[j] == static_cast<Choice>(id)) return true;
  }
  return false;
}

}  // namespace helixnav::fastslam
