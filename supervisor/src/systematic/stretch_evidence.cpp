// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/stretch_evidence.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Cholesky>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/observation.hpp"
#include "smoothing/drive_phases.hpp"

namespace helixnav::supervisor {
namespace {

using Eigen::Index;

constexpr Index errors = SystematicErrors::count;

struct SeenFrom {
  Index stop;
  const cekf::Match* match;
};

struct SeenLandmark {
  Eigen::Vector2d point_m;
  std::vector<SeenFrom> seen;
};

/// Whitened residuals and their derivatives by what they depend on.
template <int rows>
struct WhitenedRows {
  Eigen::Matrix<double, rows, 1> residual;
  Eigen::Matrix<double, rows, errors> by_errors;  ///< of the residual: it is residual + by_errors c
};

struct MotionRows : WhitenedRows<3> {
  Eigen::Matrix3d by_before, by_after;
};

struct SightingRows : WhitenedRows<2> {
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
};

/// A part of the normal equations that one landmark has, before it is eliminated.
struct OfLandmark {
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero();
  std::vector<std::pair<Index, Eigen::Matrix<double, 2, 3>>>
      with_stops;  ///< that saw it, but the first, which is the gauge
  Eigen::Matrix<double, 2, errors> with_errors = Eigen::Matrix<double, 2, errors>::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
};

class StretchProblem {
 public:
  StretchProblem(const std::vector<Stop>& stops, const std::vector<core::Pose2>& near) : stops_(stops) {
    near.empty() ? chain_poses() : begin_at(near);
    collect_landmarks();
    of_landmark_.resize(landmarks_.size());
  }

  std::optional<StretchEvidence> evidence(int most_iterations) {
    const Index of_poses = 3 * (poses() - 1);
    if (landmarks_.empty() || of_poses < 3) return std::nullopt;
    constexpr int least_iterations = 3;
    constexpr double little = 0.01;  // of χ²
    for (int i = 0; i < most_iterations; ++i) {
      if (!set_up()) return std::nullopt;
      const Eigen::LLT<Eigen::MatrixXd> factor(H_.topLeftCorner(of_poses, of_poses));
      if (factor.info() != Eigen::Success) return std::nullopt;
      const Eigen::VectorXd moved = factor.solve(g_.head(of_poses));
      step(moved);
      if (i + 1 >= least_iterations && moved.dot(g_.head(of_poses)) < little) break;
    }
    if (!set_up()) return std::nullopt;
    const Eigen::LLT<Eigen::MatrixXd> factor(H_.topLeftCorner(of_poses, of_poses));
    if (factor.info() != Eigen::Success) return std::nullopt;
    const Eigen::MatrixXd with_errors = H_.topRightCorner(of_poses, errors);
    const Eigen::MatrixXd solved = factor.solve(with_errors);
    StretchEvidence found;
    found.information = H_.bottomRightCorner<errors, errors>() - with_errors.transpose() * solved;
    found.gradient = g_.tail<errors>() - solved.transpose() * g_.head(of_poses);
    found.in_rows = in_rows_;
    found.motions = static_cast<int>(poses()) - 1;
    found.sightings = (static_cast<int>(rows_) - 3 * found.motions) / 2;
    found.chi2 = chi2_;
    found.left = g_.head(of_poses).dot(factor.solve(g_.head(of_poses)));
    found.dof = static_cast<int>(rows_ - of_poses - 2 * static_cast<Index>(landmarks_.size()));
    return found;
  }

 private:
  Index poses() const { return static_cast<Index>(stops_.size()); }

  void chain_poses() {
    at_.assign(1, core::Pose2());
    for (std::size_t k = 1; k < stops_.size(); ++k) {
      const std::optional<core::Odometry>& motion = stops_[k].motion;
      at_.push_back(motion ? core::compose(at_.back(), motion->T_before_after) : at_.back());
    }
  }

  void begin_at(const std::vector<core::Pose2>& near) {
    for (const core::Pose2& pose : near) at_.push_back(core::between(near.front(), pose));
  }

  void collect_landmarks() {
    std::map<core::LandmarkId, std::vector<SeenFrom>> seen;
    for (std::size_t k = 0; k < stops_.size(); ++k) {
      for (const cekf::Match& match : stops_[k].seen) {
        if (core::dimension(match.observation.kind) == 2) {
          seen[match.landmark].push_back({static_cast<Index>(k), &match});
        }
      }
    }
    for (auto& [id, sightings] : seen) {
      if (sightings.size() < 2) continue;
      const cekf::Match& first = *sightings.front().match;
      const core::Pose2& T_world_robot = at_[static_cast<std::size_t>(sightings.front().stop)];
      const auto located = core::locate_landmark(first.observation, T_world_robot, first.T_robot_sensor);
      landmarks_.push_back({located.point_world_m, std::move(sightings)});
    }
  }

  MotionRows rows_of_motion(std::size_t to) const {
    const core::Odometry motion = stops_[to].motion.value_or(core::Odometry());
    const core::Pose2& a = at_[to - 1];
    const core::Pose2& b = at_[to];
    const core::Pose2 predicted = core::between(a, b);
    Eigen::Matrix3d covariance = motion.covariance;
    covariance.diagonal() += softening().cwiseAbs2();
    const Eigen::LLT<Eigen::Matrix3d> root(covariance);
    const Eigen::Matrix2d R = core::rotation(a.heading_rad).transpose();
    MotionRows rows;
    rows.by_after = Eigen::Matrix3d::Identity();
    rows.by_after.topLeftCorner<2, 2>() = R;
    rows.by_before = -rows.by_after;
    rows.by_before.topRightCorner<2, 1>() = Eigen::Vector2d(predicted.y_m, -predicted.x_m);
    const core::Pose2& measured = motion.T_before_after;
    rows.residual << measured.x_m - predicted.x_m, measured.y_m - predicted.y_m,
        core::wrap_to_pi(measured.heading_rad - predicted.heading_rad);
    rows.by_errors = derivative_without_errors(measured, core::seconds(stops_[to].t_ns - stops_[to - 1].t_ns));
    const auto L = root.matrixL();
    L.solveInPlace(rows.residual);
    L.solveInPlace(rows.by_before);
    L.solveInPlace(rows.by_after);
    L.solveInPlace(rows.by_errors);
    return rows;
  }

  SightingRows rows_of_sighting(const SeenLandmark& landmark, const SeenFrom& sighting) const {
    const core::Observation& seen = sighting.match->observation;
    const core::Pose2& T_world_robot = at_[static_cast<std::size_t>(sighting.stop)];
    const core::PredictedObservation predicted =
        core::predict_observation(seen.kind, T_world_robot, sighting.match->T_robot_sensor, landmark.point_m);
    SightingRows rows;
    rows.residual = core::innovation(seen.kind, seen.z, predicted.z_hat);
    rows.by_pose = predicted.H_pose;
    rows.by_landmark = predicted.H_landmark;
    core::Observation expected = seen;  // along a measured line of sight, a derivative has the sign of the residual
    expected.z = predicted.z_hat;
    rows.by_errors = derivative_without_errors(expected);
    const Eigen::LLT<Eigen::Matrix2d> root{Eigen::Matrix2d(seen.R)};
    const auto L = root.matrixL();
    L.solveInPlace(rows.residual);
    L.solveInPlace(rows.by_pose);
    L.solveInPlace(rows.by_landmark);
    L.solveInPlace(rows.by_errors);
    return rows;
  }

  /// Normal equations of poses and errors, landmarks eliminated.
  bool set_up() {
    const Index free = 3 * (poses() - 1) + errors;
    H_.setZero(free, free);
    g_.setZero(free);
    in_rows_.setZero();
    chi2_ = 0.0;
    rows_ = 0;
    for (std::size_t k = 1; k < stops_.size(); ++k) add_motion(k);
    for (std::size_t l = 0; l < landmarks_.size(); ++l) {
      if (!add_landmark(landmarks_[l], of_landmark_[l])) return false;
    }
    return true;
  }

  Index first_column(Index stop) const { return 3 * (stop - 1); }
  Index error_column() const { return 3 * (poses() - 1); }

  void add_motion(std::size_t to) {
    const MotionRows rows = rows_of_motion(to);
    const auto stop = static_cast<Index>(to);
    const Index a = first_column(stop), e = error_column();
    H_.block<3, 3>(a, a) += rows.by_after.transpose() * rows.by_after;
    H_.block<3, errors>(a, e) -= rows.by_after.transpose() * rows.by_errors;
    H_.block<errors, errors>(e, e) += rows.by_errors.transpose() * rows.by_errors;
    g_.segment<3>(a) += rows.by_after.transpose() * rows.residual;
    g_.segment<errors>(e) -= rows.by_errors.transpose() * rows.residual;
    if (stop > 1) {
      const Index b = first_column(stop - 1);
      H_.block<3, 3>(b, b) += rows.by_before.transpose() * rows.by_before;
      H_.block<3, 3>(b, a) += rows.by_before.transpose() * rows.by_after;
      H_.block<3, 3>(a, b) += rows.by_after.transpose() * rows.by_before;
      H_.block<3, errors>(b, e) -= rows.by_before.transpose() * rows.by_errors;
      g_.segment<3>(b) += rows.by_before.transpose() * rows.residual;
    }
    in_rows_ += rows.by_errors.colwise().squaredNorm().transpose();
    chi2_ += rows.residual.squaredNorm();
    rows_ += 3;
  }

  bool add_landmark(const SeenLandmark& landmark, OfLandmark& part) {
    part = {};
    const Index e = error_column();
    for (const SeenFrom& sighting : landmark.seen) {
      const SightingRows rows = rows_of_sighting(landmark, sighting);
      part.own += rows.by_landmark.transpose() * rows.by_landmark;
      part.gradient += rows.by_landmark.transpose() * rows.residual;
      part.with_errors -= rows.by_landmark.transpose() * rows.by_errors;
      H_.block<errors, errors>(e, e) += rows.by_errors.transpose() * rows.by_errors;
      g_.segment<errors>(e) -= rows.by_errors.transpose() * rows.residual;
      if (sighting.stop > 0) {
        const Index p = first_column(sighting.stop);
        part.with_stops.emplace_back(p, rows.by_landmark.transpose() * rows.by_pose);
        H_.block<3, 3>(p, p) += rows.by_pose.transpose() * rows.by_pose;
        H_.block<3, errors>(p, e) -= rows.by_pose.transpose() * rows.by_errors;
        g_.segment<3>(p) += rows.by_pose.transpose() * rows.residual;
      }
      in_rows_ += rows.by_errors.colwise().squaredNorm().transpose();
      chi2_ += rows.residual.squaredNorm();
      rows_ += 2;
    }
    return eliminate(part);
  }

  bool eliminate(const OfLandmark& part) {
    const Eigen::LLT<Eigen::Matrix2d> factor(part.own);
    if (factor.info() != Eigen::Success) return false;
    const Index e = error_column();
    const Eigen::Matrix<double, 2, errors> errors_solved = factor.solve(part.with_errors);
    const Eigen::Vector2d gradient_solved = factor.solve(part.gradient);
    for (const auto& [p, with] : part.with_stops) {
      for (const auto& [q, with_other] : part.with_stops) {
        H_.block<3, 3>(p, q) -= with.transpose() * factor.solve(with_other);
      }
      H_.block<3, errors>(p, e) -= with.transpose() * errors_solved;
      g_.segment<3>(p) -= with.transpose() * gradient_solved;
    }
    H_.block<errors, errors>(e, e) -= part.with_errors.transpose() * errors_solved;
    g_.segment<errors>(e) -= part.with_errors.transpose() * gradient_solved;
    return true;
  }

  void step(const Eigen::VectorXd& moved) {
    for (std::size_t k = 1; k < at_.size(); ++k) {
      at_[k] = core::Pose2(Eigen::Vector3d(at_[k].vector() + moved.segment<3>(first_column(static_cast<Index>(k)))));
    }
    for (std::size_t l = 0; l < landmarks_.size(); ++l) {
      const OfLandmark& part = of_landmark_[l];
      Eigen::Vector2d gradient = part.gradient;
      for (const auto& [p, with] : part.with_stops) gradient -= with * moved.segment<3>(p);
      landmarks_[l].point_m += part.own.llt().solve(gradient);
    }
  }

  const std::vector<Stop>& stops_;
  std::vector<core::Pose2> at_;
  std::vector<SeenLandmark> landmarks_;
  std::vector<OfLandmark> of_landmark_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd g_;
  SystematicErrors::Vector in_rows_ = SystematicErrors::Vector::Zero();
  double chi2_ = 0.0;
  Index rows_ = 0;
};

}  // namespace

std::optional<StretchEvidence> evidence_of_stretch(const std::vector<Stop>& stops, const std::vector<core::Pose2>& near,
                                                   int most_iterations) {
  return StretchProblem(stops, near).evidence(most_iterations);
}

}  // namespace helixnav::supervisor
