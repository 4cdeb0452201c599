// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/innovation_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "costs.hpp"
#include "helixnav/association/chi2_table.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

using core::ObservationKind;

constexpr int kinds = 4;

/// Observation padded to two rows.
struct PaddedObservation {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
};

struct Thresholds {
  double match;
  double fresh;
};

bool is_usable(const core::Observation& observation) {
  const int d = core::dimension(observation.kind);
  if (observation.z.size() != d || observation.R.rows() != d || observation.R.cols() != d) return false;
  if (!observation.z.allFinite() || !(observation.R(0, 0) > 0.0) || !std::isfinite(observation.R(0, 0))) return false;
  if (d == 1) return true;
  const double determinant = observation.R(0, 0) * observation.R(1, 1) - observation.R(0, 1) * observation.R(1, 0);
  return observation.R(0, 1) == observation.R(1, 0) && determinant > 0.0 && std::isfinite(determinant);
}

PaddedObservation padded(const core::Observation& observation) {
  // The cheap test comes first: check_observation allocates, and has the final say and the better message.
  if (!is_usable(observation)) core::check_observation(observation);
  const int d = core::dimension(observation.kind);
  PaddedObservation result;
  result.z.head(d) = observation.z;
  result.R.topLeftCorner(d, d) = observation.R;
  return result;
}

Thresholds thresholds(const Gates& gates, int dof) {
  if (!(gates.match_probability > 0.0 && gates.match_probability <= gates.new_probability &&
        gates.new_probability < 1.0)) {
    throw core::PreconditionError("association gates: 0 < match_probability <= new_probability < 1 expected, got " +
                                  std::to_string(gates.match_probability) + " and " +
                                  std::to_string(gates.new_probability));
  }
  return {chi2_threshold(gates.match_probability, dof), chi2_threshold(gates.new_probability, dof)};
}

/// ẑ and H of one candidate, without covariances; false when it is at the sensor.
bool predict_mean(ObservationKind kind, const core::Pose2& T_world_robot, const core::Scan& scan,
                  const Eigen::Vector2d& point_m, Prediction& out) {
  try {
    const core::PredictedObservation p = core::predict_observation(kind, T_world_robot, scan.T_robot_sensor, point_m);
    const int d = core::dimension(kind);
    out.kind = kind;
    out.z_hat.setZero();
    out.H_pose.setZero();
    out.H_landmark.setZero();
    out.z_hat.head(d) = p.z_hat;
    out.H_pose.topRows(d) = p.H_pose;
    out.H_landmark.topRows(d) = p.H_landmark;
    return true;
  } catch (const core::NumericalError&) {
    return false;
  }
}

void predict_covariance(const Eigen::MatrixXd& P, Prediction& p) {
  const int column = 3 + 2 * p.candidate;
  const Eigen::Matrix<double, 3, 2> P_vm = P.block<3, 2>(0, column);
  p.P_vm_Hm.noalias() = P_vm * p.H_landmark.transpose();
  p.C_pose.noalias() = p.H_pose * P.topLeftCorner<3, 3>();
  p.C_pose.noalias() += p.H_landmark * P_vm.transpose();
  p.HPHt.noalias() = p.C_pose * p.H_pose.transpose();
  p.HPHt.noalias() += p.H_pose * p.P_vm_Hm;
  p.P_mm_Hm.noalias() = P.block<2, 2>(column, column) * p.H_landmark.transpose();
  p.HPHt.noalias() += p.H_landmark * p.P_mm_Hm;
}

Eigen::Vector2d padded_innovation(ObservationKind kind, const Eigen::Vector2d& z, const Eigen::Vector2d& z_hat) {
  Eigen::Vector2d nu = z - z_hat;
  if (kind == ObservationKind::range_bearing) nu[1] = core::wrap_to_pi(nu[1]);
  if (kind == ObservationKind::bearing) nu[0] = core::wrap_to_pi(nu[0]);
  return nu;
}

/// Fills ν, S, NIS and likelihood of the pair. False when the NIS exceeds the limit, mostly found by one component.
bool compare(const PaddedObservation& observation, const Prediction& prediction, double nis_limit, GatedPair& pair) {
  pair.nu = padded_innovation(prediction.kind, observation.z, prediction.z_hat);
  pair.S = prediction.HPHt + observation.R;
  const double determinant = pair.S(0, 0) * pair.S(1, 1) - pair.S(0, 1) * pair.S(1, 0);
  if (!(pair.S(0, 0) > 0.0) || !(determinant > 0.0) || !std::isfinite(determinant) || !pair.nu.allFinite()) {
    throw core::NumericalError("not positive definite");
  }
  if (pair.nu[0] * pair.nu[0] > nis_limit * pair.S(0, 0) || pair.nu[1] * pair.nu[1] > nis_limit * pair.S(1, 1)) {
    return false;
  }
  pair.nis = (pair.nu[0] * (pair.S(1, 1) * pair.nu[0] - pair.S(0, 1) * pair.nu[1]) +
              pair.nu[1] * (pair.S(0, 0) * pair.nu[1] - pair.S(1, 0) * pair.nu[0])) /
             determinant;
  pair.log_likelihood = -0.5 * (pair.nis + std::log(determinant) + pair.dof * ln_2pi);
  return pair.nis <= nis_limit;
}

/// What class and size add to the distance of a pair, and the gates that this is judged by.
struct Looks {
  double nis = 0.0;
  Thresholds limit;
};

Looks look_at(const core::Appearance& seen, core::LandmarkId id, const Gates& gates,
              const core::MapAppearance* appearance, const Thresholds& by_place, GatedPair& pair) {
  pair.appearance_nats = 0.0;
  if (appearance == nullptr || !seen.is_given()) return {0.0, by_place};
  const core::AppearanceEvidence evidence = appearance->compare(id, seen);
  pair.appearance_nats = evidence.nats;
  return {evidence.size_nis + evidence.gate, evidence.size_dof == 0 ? by_place : thresholds(gates, pair.dof + 1)};
}

/// Predictions of one kind are contiguous in problem.predictions: [begin, end) of each kind.
using KindRanges = std::array<std::pair<int, int>, kinds>;

template <typename PredictionsOfKind>
KindRanges predict_kinds(const core::Scan& scan, InnovationProblem& problem, const PredictionsOfKind& predict) {
  std::array<bool, kinds> present{};
  for (const core::Observation& observation : scan.observations) present[static_cast<int>(observation.kind)] = true;
  KindRanges ranges{};
  problem.predictions.reserve(problem.ids.size());
  for (int k = 0; k < kinds; ++k) {
    ranges[k].first = static_cast<int>(problem.predictions.size());
    if (present[k]) predict(static_cast<ObservationKind>(k));
    ranges[k].second = static_cast<int>(problem.predictions.size());
  }
  return ranges;
}

void gate_observation(const core::Observation& observation, int index, std::pair<int, int> range, const Gates& gates,
                      const core::MapAppearance* appearance, InnovationProblem& problem) {
  const PaddedObservation z = padded(observation);
  GatedObservation gated;
  gated.kind = observation.kind;
  gated.dof = core::dimension(observation.kind);
  gated.begin = static_cast<int>(problem.pairs.size());
  const Thresholds limit = thresholds(gates, gated.dof);
  GatedPair pair;
  pair.observation = index;
  pair.dof = gated.dof;
  for (int p = range.first; p < range.second; ++p) {
    const Prediction& prediction = problem.predictions[p];
    pair.candidate = prediction.candidate;
    pair.prediction = p;
    try {
      if (!compare(z, prediction, limit.fresh, pair)) continue;
    } catch (const core::NumericalError&) {
      throw core::NumericalError("innovation covariance of observation " + std::to_string(index) + " and landmark " +
                                 std::to_string(problem.ids[prediction.candidate]) +
                                 " is not finite and positive definite");
    }
    const Looks looks =
        look_at(observation.appearance, problem.ids[prediction.candidate], gates, appearance, limit, pair);
    if (pair.nis + looks.nis > looks.limit.fresh) continue;
    if (pair.nis < gated.nearest_nis) {
      gated.nearest_nis = pair.nis;
      gated.nearest_candidate = pair.candidate;
    }
    if (pair.nis + looks.nis <= looks.limit.match) problem.pairs.push_back(pair);
  }
  gated.end = static_cast<int>(problem.pairs.size());
  std::sort(problem.pairs.begin() + gated.begin, problem.pairs.end(), [](const GatedPair& a, const GatedPair& b) {
    return a.nis != b.nis ? a.nis < b.nis : a.candidate < b.candidate;
  });
  problem.observations.push_back(gated);
}

void gate_all(const core::Scan& scan, const KindRanges& ranges, const Gates& gates,
              const core::MapAppearance* appearance, InnovationProblem& problem) {
  thresholds(gates, 1);  // wrong gates are refused for an empty scan too
  problem.observations.reserve(scan.observations.size());
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    const core::Observation& observation = scan.observations[i];
    gate_observation(observation, static_cast<int>(i), ranges[static_cast<int>(observation.kind)], gates, appearance,
                     problem);
  }
}

}  // namespace

InnovationProblem make_innovation_problem(const core::JointGaussian& joint, const core::Scan& scan, const Gates& gates,
                                          const core::MapAppearance* appearance) {
  const auto n = static_cast<Eigen::Index>(joint.ids.size());
  if (joint.points_m.size() != joint.ids.size() || joint.covariance.rows() != 3 + 2 * n ||
      joint.covariance.cols() != 3 + 2 * n) {
    throw core::PreconditionError("association: " + std::to_string(n) + " candidates need as many points and a " +
                                  std::to_string(3 + 2 * n) + "-square covariance");
  }
  InnovationProblem problem;
  problem.ids = joint.ids;
  problem.covariance = &joint.covariance;
  const KindRanges ranges = predict_kinds(scan, problem, [&](ObservationKind kind) {
    for (int j = 0; j < n; ++j) {
      Prediction prediction;
      prediction.candidate = j;
      if (!predict_mean(kind, joint.pose, scan, joint.points_m[j], prediction)) continue;
      predict_covariance(joint.covariance, prediction);
      problem.predictions.push_back(prediction);
    }
  });
  gate_all(scan, ranges, gates, appearance, problem);
  return problem;
}

InnovationProblem make_innovation_problem(const core::Pose2& T_world_robot, const std::vector<core::LandmarkId>& ids,
                                          const std::vector<core::PointGaussian>& landmarks, const core::Scan& scan,
                                          const Gates& gates) {
  if (landmarks.size() != ids.size()) {
    throw core::PreconditionError("association: as many landmarks as ids expected");
  }
  InnovationProblem problem;
  problem.ids = ids;
  const KindRanges ranges = predict_kinds(scan, problem, [&](ObservationKind kind) {
    for (int j = 0; j < static_cast<int>(ids.size()); ++j) {
      Prediction prediction;
      prediction.candidate = j;
      if (!predict_mean(kind, T_world_robot, scan, landmarks[j].mean_m, prediction)) continue;
      prediction.C_pose.setZero();
      prediction.P_vm_Hm.setZero();
      prediction.P_mm_Hm = landmarks[j].covariance_m2 * prediction.H_landmark.transpose();
      prediction.HPHt = prediction.H_landmark * prediction.P_mm_Hm;
      problem.predictions.push_back(prediction);
    }
  });
  gate_all(scan, ranges, gates, nullptr, problem);
  return problem;
}

}  // namespace helixnav::association
