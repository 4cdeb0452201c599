// SPDX-License-Identifier: BSD-3-Clause
#include "association/revisit_ambiguity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "association/view_area.hpp"
#include "helixnav/association/likelihood_ratio.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double gate_probability = 0.95;  // of the gate in which confusers are counted
constexpr double too_near_m = 1e-3;        // at the sensor itself there is no bearing

double confuser_gate() {
  static const double gate = core::chi2_quantile(gate_probability, 2);
  return gate;
}

bool is_in_sorted(const std::vector<core::LandmarkId>& sorted, core::LandmarkId id) {
  return std::binary_search(sorted.begin(), sorted.end(), id);
}

/// Extraneous objects per unit of the observation space at ẑ: in polar coordinates there is more ground farther out.
double density_at(const association::Prediction& prediction, const core::FieldOfView& view, double per_scan) {
  const double per_m2 = per_scan / view_area_m2(view);
  return prediction.kind == core::ObservationKind::range_bearing ? per_m2 * prediction.z_hat.x() : per_m2;
}

/// By how much the gate is larger than sensor noise alone would make it.
double widened_area(const Eigen::Matrix2d& S, const Eigen::Matrix2d& R) {
  return core::pi * confuser_gate() * (std::sqrt(std::max(0.0, S.determinant())) - std::sqrt(R.determinant()));
}

bool is_wide(const Eigen::Matrix2d& S, const Eigen::Matrix2d& R) {
  return S.determinant() > drifted_widening * drifted_widening * R.determinant();
}

/// S of an observation of the landmark with the noise of `like`, wherever it is predicted.
Eigen::Matrix2d innovation_covariance(const cekf::CompressedEkf& filter, core::LandmarkId id,
                                      const core::Observation& like, const core::Pose2& T_robot_sensor) {
  const core::JointGaussian joint = filter.joint({id});
  const Eigen::Vector2d sensor_m = core::transform(joint.pose, T_robot_sensor.position_m());
  if ((joint.points_m.front() - sensor_m).norm() < too_near_m) return like.R;
  const core::PredictedObservation predicted =
      core::predict_observation(like.kind, joint.pose, T_robot_sensor, joint.points_m.front());
  Eigen::Matrix<double, 2, 5> H;
  H << predicted.H_pose, predicted.H_landmark;
  return H * joint.covariance * H.transpose() + Eigen::Matrix2d(like.R);
}

/// Old landmarks that the sensor may have in view.
std::vector<core::LandmarkId> old_in_view(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                          const std::vector<core::LandmarkId>& old) {
  const core::PoseGaussian now = filter.pose();
  const double sigma_m = std::sqrt(std::max(0.0, now.covariance.topLeftCorner<2, 2>().trace()));
  const Eigen::Vector2d sensor_m = core::transform(now.mean, scan.T_robot_sensor.position_m());
  std::vector<core::LandmarkId> near =
      filter.landmarks_within(sensor_m, scan.field_of_view.max_range_m + 3.0 * sigma_m);
  near.erase(std::remove_if(near.begin(), near.end(), [&](core::LandmarkId id) { return !is_in_sorted(old, id); }),
             near.end());
  return near;
}

bool may_be(const association::InnovationProblem& problem, int observation, core::LandmarkId id, double gate) {
  const association::GatedObservation& here = problem.observations[static_cast<std::size_t>(observation)];
  return std::any_of(problem.pairs.begin() + here.begin, problem.pairs.begin() + here.end,
                     [&](const association::GatedPair& pair) {
                       return problem.ids[static_cast<std::size_t>(pair.candidate)] == id && pair.nis < gate;
                     });
}

/// How likely it is to look like that compared with what the pair says, at most 1. By class and size alone.
double share_alike(double nats, const association::GatedPair& pair) {
  return std::exp(std::min(0.0, nats - pair.appearance_nats));
}

struct Neighbours {
  int count = 0;
  double alike = 0.0;  ///< weighted by what class and size say
};

/// Other landmarks in the gate of the pair's landmark, or in whose gates its observation is as well: two on either
/// side of it may be outside each other's gates and yet be about equally likely.
Neighbours neighbours_in_gate(const cekf::CompressedEkf& filter, const core::Scan& scan,
                              const std::vector<core::LandmarkId>& others, core::LandmarkId self,
                              const association::GatedPair& pair, const association::InnovationProblem& problem,
                              const core::MapAppearance& appearance) {
  const double gate = confuser_gate();
  const association::Prediction& prediction = problem.predictions[static_cast<std::size_t>(pair.prediction)];
  const core::Pose2 pose = filter.pose().mean;
  const Eigen::Vector2d sensor_m = core::transform(pose, scan.T_robot_sensor.position_m());
  const Eigen::Matrix2d S_inverse = pair.S.inverse();
  const core::Appearance& seen = scan.observations[static_cast<std::size_t>(pair.observation)].appearance;
  Neighbours neighbours;
  for (const core::LandmarkId other : others) {
    const Eigen::Vector2d point_m = filter.landmark_mean(other);
    if (other == self || (point_m - sensor_m).norm() < too_near_m) continue;
    const core::ObsVector z_hat = core::predict_observation(prediction.kind, pose, scan.T_robot_sensor, point_m).z_hat;
    const Eigen::Vector2d nu = core::innovation(prediction.kind, z_hat, core::ObsVector(prediction.z_hat));
    if (!(nu.dot(S_inverse * nu) < gate || may_be(problem, pair.observation, other, gate))) continue;
    ++neighbours.count;
    neighbours.alike += share_alike(appearance.compare(other, seen).nats, pair);
  }
  return neighbours;
}

/// One entry per landmark, ascending: the most ambiguous one.
void keep_worst(const RevisitAmbiguity& here, std::vector<RevisitAmbiguity>& returns) {
  const auto at = std::lower_bound(returns.begin(), returns.end(), here.landmark,
                                   [](const RevisitAmbiguity& r, core::LandmarkId l) { return r.landmark < l; });
  if (at == returns.end() || at->landmark != here.landmark) {
    returns.insert(at, here);
  } else if (here.expected_confusers > at->expected_confusers) {
    *at = here;
  }
}

}  // namespace

std::vector<core::LandmarkId> old_landmarks(const association::LandmarkLife& life, double old_after_m) {
  std::vector<core::LandmarkId> old;
  for (const association::LandmarkRecord& record : life.records()) {
    const bool unseen = life.path_m() - record.last_seen_path_m > old_after_m;
    if (unseen && record.state == core::LandmarkState::mature) old.push_back(record.id);
  }
  return old;
}

std::vector<RevisitAmbiguity> returns_in_gate(const cekf::CompressedEkf& filter,
                                              const association::InnovationProblem& problem, const core::Scan& scan,
                                              const std::vector<core::LandmarkId>& old, double extraneous_per_scan,
                                              const core::MapAppearance& appearance) {
  std::vector<RevisitAmbiguity> returns;
  if (old.empty() || !scan.field_of_view.reach()) return returns;  // a sensor of unknown view
  std::vector<core::LandmarkId> others;                            // looked up when the first old landmark is gated
  for (const association::GatedPair& pair : problem.pairs) {
    const core::LandmarkId id = problem.ids[static_cast<std::size_t>(pair.candidate)];
    if (pair.dof != 2 || !is_in_sorted(old, id)) continue;
    if (others.empty()) others = old_in_view(filter, scan, old);
    const association::Prediction& prediction = problem.predictions[static_cast<std::size_t>(pair.prediction)];
    RevisitAmbiguity here;
    here.landmark = id;
    const Neighbours neighbours = neighbours_in_gate(filter, scan, others, id, pair, problem, appearance);
    here.neighbours = neighbours.count;
    const Eigen::Matrix2d R = scan.observations[static_cast<std::size_t>(pair.observation)].R;
    here.widening = std::sqrt(pair.S.determinant() / R.determinant());
    here.gate_area = widened_area(pair.S, R);
    here.extraneous_density = density_at(prediction, scan.field_of_view, extraneous_per_scan);
    const double extraneous = here.extraneous_density * here.gate_area;
    here.expected_confusers = neighbours.alike + share_alike(0.0, pair) * extraneous;
    keep_worst(here, returns);
  }
  return returns;
}

std::vector<core::LandmarkId> drifted_from(const association::InnovationProblem& problem, const core::Scan& scan) {
  std::vector<core::LandmarkId> drifted;
  for (const association::GatedPair& pair : problem.pairs) {
    const core::ObsMatrix& R = scan.observations[static_cast<std::size_t>(pair.observation)].R;
    if (pair.dof != 2 || !is_wide(pair.S, R)) continue;
    drifted.push_back(problem.ids[static_cast<std::size_t>(pair.candidate)]);
  }
  std::sort(drifted.begin(), drifted.end());
  drifted.erase(std::unique(drifted.begin(), drifted.end()), drifted.end());
  return drifted;
}

std::vector<core::LandmarkId> old_or_drifted(const cekf::CompressedEkf& filter, const association::LandmarkLife& life,
                                             const core::Scan& scan, double old_after_m) {
  std::vector<core::LandmarkId> old = old_landmarks(life, old_after_m);
  const auto seen = std::find_if(scan.observations.begin(), scan.observations.end(),
                                 [](const core::Observation& one) { return core::dimension(one.kind) == 2; });
  if (seen == scan.observations.end()) return old;
  std::vector<core::LandmarkId> drifted;
  for (const association::LandmarkRecord& record : life.records()) {
    if (record.state != core::LandmarkState::mature || !filter.contains(record.id)) continue;
    if (is_in_sorted(old, record.id)) continue;
    if (is_wide(innovation_covariance(filter, record.id, *seen, scan.T_robot_sensor), seen->R))
      drifted.push_back(record.id);
  }
  const auto middle = old.insert(old.end(), drifted.begin(), drifted.end());
  std::inplace_merge(old.begin(), middle, old.end());
  return old;
}

double extraneous_in_gate(const association::InnovationProblem& problem, const association::GatedPair& pair,
                          const Eigen::Matrix2d& S, const core::Scan& scan, double extraneous_per_scan) {
  const association::Prediction& prediction = problem.predictions[static_cast<std::size_t>(pair.prediction)];
  const Eigen::Matrix2d R = scan.observations[static_cast<std::size_t>(pair.observation)].R;
  return share_alike(0.0, pair) * density_at(prediction, scan.field_of_view, extraneous_per_scan) * widened_area(S, R);
}

const RevisitAmbiguity* most_ambiguous(const std::vector<RevisitAmbiguity>& returns) {
  const RevisitAmbiguity* worst = nullptr;
  for (const RevisitAmbiguity& met : returns) {
    if (met.is_mature && (worst == nullptr || worst->expected_confusers < met.expected_confusers)) worst = &met;
  }
  return worst;
}

}  // namespace helixnav::supervisor
