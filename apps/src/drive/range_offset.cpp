// SPDX-License-Identifier: BSD-3-Clause
#include "range_offset.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/merged_ids.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::apps {
namespace {

/// A match with its whitened derivatives by the pose and the landmark. The columns of `left` are the residual and its
/// derivative by the offset; what poses and landmarks explain of both is taken out of them.
struct Pair {
  std::size_t scan = 0, landmark = 0;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
  Eigen::Matrix2d left;
};

constexpr double outlier_nis = 30.0;  // one in 3 million
constexpr double nearest_m = 1e-3;    // nothing is seen at such a short range

std::optional<Pair> pair_of(const core::Observation& seen, const core::Pose2& T_world_robot,
                            const core::Pose2& T_robot_sensor, const Eigen::Vector2d& point_m) {
  if (seen.kind != core::ObservationKind::range_bearing) return std::nullopt;
  const Eigen::Vector2d sensor_m = core::compose(T_world_robot, T_robot_sensor).position_m();
  if (!((point_m - sensor_m).norm() > nearest_m)) return std::nullopt;
  const auto predicted = core::predict_observation(seen.kind, T_world_robot, T_robot_sensor, point_m);
  const Eigen::LLT<Eigen::Matrix2d> R(Eigen::Matrix2d(seen.R));
  Pair pair;
  pair.by_pose = R.matrixL().solve(Eigen::Matrix<double, 2, 3>(predicted.H_pose));
  pair.by_landmark = R.matrixL().solve(Eigen::Matrix2d(predicted.H_landmark));
  pair.left.col(0) = core::innovation(seen.kind, seen.z, predicted.z_hat);
  pair.left.col(1) = -Eigen::Vector2d::UnitX();  // measured ranges are short by it
  pair.left = R.matrixL().solve(pair.left).eval();
  if (!(pair.left.col(0).squaredNorm() < outlier_nis)) return std::nullopt;
  return pair;
}

/// Where the landmarks that lasted are, by id.
std::map<core::LandmarkId, std::pair<std::size_t, Eigen::Vector2d>> mature_points(const runs::Run& run) {
  std::map<core::LandmarkId, std::pair<std::size_t, Eigen::Vector2d>> points;
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    points.emplace(landmark.id, std::pair(points.size(), landmark.point.mean_m));
  }
  return points;
}

std::vector<Pair> pairs_of(const core::Recording& recording, const runs::Run& run) {
  const auto points = mature_points(run);
  const core::MergedIds merged(run.steps);
  std::vector<Pair> pairs;
  std::size_t k = 0;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    if (k >= run.steps.size()) break;
    const core::Pose2& T_world_robot = k < run.final_path.size() ? run.final_path[k] : run.steps[k].pose.mean;
    for (const core::AssociationReport& a : run.steps[k].associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      const auto i = static_cast<std::size_t>(a.observation);
      if (!used || i >= scan->observations.size()) continue;
      const auto landmark = points.find(merged.now(a.landmark));
      if (landmark == points.end()) continue;
      auto pair = pair_of(scan->observations[i], T_world_robot, scan->T_robot_sensor, landmark->second.second);
      if (!pair) continue;
      pair->scan = k;
      pair->landmark = landmark->second.first;
      pairs.push_back(*pair);
    }
    ++k;
  }
  return pairs;
}

/// Takes out of the residuals what variables of N coordinates explain with the others held fixed.
template <int N>
class Elimination {
 public:
  Elimination(const std::vector<Pair>& pairs, std::size_t Pair::*variable,
              Eigen::Matrix<double, 2, N> Pair::*derivative)
      : variable_(variable), derivative_(derivative) {
    std::size_t count = 0;
    for (const Pair& pair : pairs) count = std::max(count, pair.*variable + 1);
    constexpr double hardly_any = 1e-6;  // 1 km, 1000 rad: what a scan with a single pair leaves open
    inverse_.assign(count, hardly_any * Matrix::Identity());
    for (const Pair& pair : pairs) inverse_[pair.*variable] += (pair.*derivative).transpose() * (pair.*derivative);
    for (Matrix& matrix : inverse_) matrix = matrix.inverse().eval();
  }

  void take_out_of(std::vector<Pair>& pairs) const {
    std::vector<Eigen::Matrix<double, N, 2>> moved(inverse_.size(), Eigen::Matrix<double, N, 2>::Zero());
    for (const Pair& pair : pairs) moved[pair.*variable_] += (pair.*derivative_).transpose() * pair.left;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = (inverse_[i] * moved[i]).eval();
    for (Pair& pair : pairs) pair.left -= (pair.*derivative_) * moved[pair.*variable_];
  }

 private:
  using Matrix = Eigen::Matrix<double, N, N>;

  std::size_t Pair::*variable_;
  Eigen::Matrix<double, 2, N> Pair::*derivative_;
  std::vector<Matrix> inverse_;
};

/// Rows less those used by landmarks and poses: for a scan with a single pair both of its rows.
double degrees_of_freedom(const std::vector<Pair>& pairs) {
  std::map<std::size_t, int> of_scan, of_landmark;
  for (const Pair& pair : pairs) {
    ++of_scan[pair.scan];
    ++of_landmark[pair.landmark];
  }
  double dof = 2.0 * static_cast<double>(pairs.size()) - 2.0 * static_cast<double>(of_landmark.size());
  for (const auto& [scan, count] : of_scan) dof -= std::min(3, 2 * count);
  return dof;
}

}  // namespace

std::optional<RangeOffset> range_offset_of(const core::Recording& recording, const runs::Run& run) {
  std::vector<Pair> pairs = pairs_of(recording, run);
  const double dof = degrees_of_freedom(pairs);
  if (!(dof > 0.0)) return std::nullopt;
  const Elimination<2> landmarks(pairs, &Pair::landmark, &Pair::by_landmark);
  const Elimination<3> poses(pairs, &Pair::scan, &Pair::by_pose);
  constexpr int turns = 16;
  for (int i = 0; i < turns; ++i) {
    landmarks.take_out_of(pairs);
    poses.take_out_of(pairs);
  }
  double information = 0.0, gradient = 0.0, chi2 = 0.0;
  for (const Pair& pair : pairs) {
    information += pair.left.col(1).squaredNorm();
    gradient += pair.left.col(1).dot(pair.left.col(0));
    chi2 += pair.left.col(0).squaredNorm();
  }
  if (!(information > 0.0)) return std::nullopt;
  return RangeOffset{gradient / information, std::sqrt(std::max(1.0, chi2 / dof) / information)};
}

}  // namespace helixnav::apps
