// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "matrices/make_room.hpp"
#include "update/innovation.hpp"

namespace helixnav::cekf {

core::LandmarkId CompressedEkf::augment(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
  const core::LandmarkId name = active_.next_id;
  augment(observation, T_robot_sensor, name);
  return name;
}

void CompressedEkf::augment(const core::Observation& observation, const core::Pose2& T_robot_sensor,
                            core::LandmarkId name) {
  check_observation_of({name, observation, T_robot_sensor}, "augment");
  const bool is_last = name == std::numeric_limits<core::LandmarkId>::max();  // no name would be left above it
  if (name < 0 || is_last || contains(name)) {
    throw core::PreconditionError("augment: the name " + std::to_string(name) + " is taken, negative or the last");
  }
  const core::LocatedLandmark located = core::locate_landmark(observation, active_.pose, T_robot_sensor);
  const Eigen::Matrix<double, 3, 2> G = located.G_pose.transpose();
  const Eigen::Matrix2d own = located.G_pose * active_.P.view().topLeftCorner<3, 3>() * G +
                              located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
  check_newest(located.point_world_m, own);
  make_room_for_newest();

  // Nothing below allocates or throws.
  const int n = active_.dimension();
  active_.P.resize(n + 2, n + 2);
  active_.A.resize(active_.weights(), n + 2);
  auto P = active_.P.view();
  auto A = active_.A.view();
  P.block(0, n, n, 2).noalias() = P.topLeftCorner(n, 3).lazyProduct(G);
  P.block(n, 0, 2, n) = P.block(0, n, n, 2).transpose();
  P.block<2, 2>(n, n) = 0.5 * (own + own.transpose());
  A.rightCols<2>().noalias() = A.leftCols<3>().lazyProduct(G);

  name_newest(located.point_world_m, name);
}

core::LandmarkId CompressedEkf::augment(const DerivedPoint& point) {
  check_derived_point(point);
  const core::LandmarkId name = active_.next_id;
  BeforeActivations before = before_activations(false);
  try {
    for (const core::LandmarkId id : point.ids) activate(id);
    make_room_for_newest();
    derive_newest(point);
  } catch (...) {
    undo_activations(before);
    throw;
  }
  name_newest(point.point_m, name);
  return name;
}

/// Row and column of a landmark that has no name yet.
void CompressedEkf::derive_newest(const DerivedPoint& point) {
  const int n = active_.dimension();
  active_.P.resize(n + 2, n + 2);
  active_.A.resize(active_.weights(), n + 2);
  auto P = active_.P.view();
  auto A = active_.A.view();
  const auto add = [&](int column, int width, const Eigen::Ref<const Eigen::MatrixXd>& G) {
    P.block(0, n, n, 2).noalias() += P.block(0, column, n, width).lazyProduct(G.transpose());
    A.rightCols<2>().noalias() += A.middleCols(column, width).lazyProduct(G.transpose());
  };
  P.rightCols<2>().setZero();
  A.rightCols<2>().setZero();
  add(0, 3, point.G.leftCols(3));
  for (std::size_t k = 0; k < point.ids.size(); ++k) {
    add(ActivePart::column(place_of(point.ids[k], "augment").index), 2,
        point.G.middleCols(3 + 2 * static_cast<Eigen::Index>(k), 2));
  }
  Eigen::Matrix2d own = point.noise_m2 + point.G.leftCols(3) * P.block(0, n, 3, 2);
  for (std::size_t k = 0; k < point.ids.size(); ++k) {
    const int column = ActivePart::column(place_of(point.ids[k], "augment").index);
    own += point.G.middleCols(3 + 2 * static_cast<Eigen::Index>(k), 2) * P.block(column, n, 2, 2);
  }
  check_newest(point.point_m, own);
  P.block(n, 0, 2, n) = P.block(0, n, n, 2).transpose();
  P.block<2, 2>(n, n) = 0.5 * (own + own.transpose());
}

void CompressedEkf::check_newest(const Eigen::Vector2d& point_m, const Eigen::Matrix2d& covariance_m2) const {
  if (point_m.allFinite() && covariance_m2.allFinite() && covariance_m2.diagonal().minCoeff() >= 0.0) return;
  std::ostringstream problem;
  problem << "augment: the landmark would stand at (" << point_m.x() << " m, " << point_m.y() << " m) with variances "
          << covariance_m2(0, 0) << " m2 and " << covariance_m2(1, 1) << " m2";
  throw core::NumericalError(problem.str());
}

void CompressedEkf::make_room_for_newest() {
  make_room_for_landmark(active_.weights());
  make_room(places_, 1);
}

void CompressedEkf::check_derived_point(const DerivedPoint& point) const {
  for (const core::LandmarkId id : point.ids) place_of(id, "augment");
  if (point.G.cols() != 3 + 2 * static_cast<Eigen::Index>(point.ids.size()) || !point.G.allFinite() ||
      !point.point_m.allFinite() || !core::is_symmetric_positive_semidefinite(point.noise_m2)) {
    throw core::PreconditionError(
        "augment: a derived point needs a finite 2×(3+2·ids) G and a covariance of its noise");
  }
}

void CompressedEkf::name_newest(const Eigen::Vector2d& point_m, core::LandmarkId id) {
  name_from(id + 1);
  set_place(id, {Whereabouts::active, active_count()});
  active_.ids.push_back(id);
  active_.slots.push_back(-1);
  active_.points_m.push_back(point_m);
}

}  // namespace helixnav::cekf
