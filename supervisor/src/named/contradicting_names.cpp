// SPDX-License-Identifier: BSD-3-Clause
#include "named/contradicting_names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/association/chi2_table.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/in_view.hpp"

namespace helixnav::supervisor {
namespace {

using Eigen::Index;

constexpr double usual = 0.999;

int rows_of(const std::vector<cekf::Match>& matches) {
  int rows = 0;
  for (const cekf::Match& match : matches) rows += core::dimension(match.observation.kind);
  return rows;
}

/// The vehicle anywhere around its predicted pose (standard deviations).
cekf::CompressedEkf moved_by_up_to(const cekf::CompressedEkf& filter, double moved_m, double turned_rad) {
  cekf::CompressedEkf moved = filter;
  core::PoseGaussian pose = filter.pose();
  pose.covariance.diagonal() += Eigen::Vector3d(moved_m * moved_m, moved_m * moved_m, turned_rad * turned_rad);
  moved.replace_pose(pose);
  return moved;
}

double log_likelihood(const cekf::Innovation& innovation, double noise_scale) {
  const Eigen::LLT<Eigen::MatrixXd> S(noise_scale * innovation.S);
  if (S.info() != Eigen::Success)
    throw core::NumericalError("named: the innovation covariance is not positive definite");
  const double rows = static_cast<double>(innovation.nu.size());
  return -0.5 * innovation.nu.dot(S.solve(innovation.nu)) - S.matrixLLT().diagonal().array().log().sum() -
         0.5 * rows * std::log(2.0 * core::pi);
}

/// Density of a sighting of anything, which may be anywhere in view, in the units of the observation.
double density_of_any(core::ObservationKind kind, const AssumedOfNames& assumed) {
  const core::FieldOfView& view = assumed.view;
  const double far_m = view.reach().value_or(assumed.reach_m);
  const double near_m = std::clamp(view.min_range_m, 0.0, 0.5 * far_m);
  const double angle = std::clamp(view.max_bearing_rad - view.min_bearing_rad, 0.01, 2.0 * core::pi);
  switch (kind) {
    case core::ObservationKind::range_bearing:
      return 1.0 / (angle * (far_m - near_m));
    case core::ObservationKind::cartesian:
      return 2.0 / (angle * (far_m * far_m - near_m * near_m));
    case core::ObservationKind::bearing:
      return 1.0 / angle;
    case core::ObservationKind::range:
      return 1.0 / (far_m - near_m);
  }
  return 0.0;
}

/// Each sighting given all others still included: from their S⁻¹ and S⁻¹ν, whose block and rows for a sighting are the
/// information and the weighted residual of that sighting given the rest.
class GivenOthers {
 public:
  GivenOthers(const cekf::Innovation& innovation, const std::vector<cekf::Match>& matches, double noise_scale) {
    const Eigen::LLT<Eigen::MatrixXd> S(noise_scale * innovation.S);
    if (S.info() != Eigen::Success)
      throw core::NumericalError("named: the innovation covariance is not positive definite");
    information_ = S.solve(Eigen::MatrixXd::Identity(innovation.S.rows(), innovation.S.cols()));
    residual_ = information_ * innovation.nu;
    Index row = 0;
    for (const cekf::Match& match : matches) {
      rows_.push_back({row, core::dimension(match.observation.kind)});
      row += rows_.back().count;
    }
  }

  int dof(std::size_t i) const { return static_cast<int>(rows_[i].count); }
  double nis(std::size_t i) const {
    const Eigen::VectorXd r = residual_.segment(rows_[i].first, rows_[i].count);
    return r.dot(own(i).llt().solve(r));
  }
  double log_likelihood(std::size_t i) const {
    return 0.5 * (std::log(own(i).determinant()) - nis(i) - dof(i) * std::log(2.0 * core::pi));
  }

  /// The others are no longer conditioned on it.
  void leave_out(std::size_t i) {
    const Index first = rows_[i].first, count = rows_[i].count;
    const Eigen::MatrixXd columns = information_.middleCols(first, count);
    const Eigen::MatrixXd by_own = own(i).llt().solve(columns.transpose()).transpose();
    residual_ -= by_own * Eigen::VectorXd(residual_.segment(first, count));
    information_ -= by_own * columns.transpose();
  }

 private:
  struct Rows {
    Index first = 0;
    Index count = 0;
  };
  Eigen::MatrixXd own(std::size_t i) const {
    return information_.block(rows_[i].first, rows_[i].first, rows_[i].count, rows_[i].count);
  }

  std::vector<Rows> rows_;
  Eigen::MatrixXd information_;
  Eigen::VectorXd residual_;
};

/// At the minimum over pose and landmarks. Infinite if the way there leads onto a landmark, from where nothing can be
/// seen: then no pose explains the sightings.
double least_cost(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches) {
  try {
    return filter.iterated_cost(matches).cost;
  } catch (const core::NumericalError&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

double usual_nis(const std::vector<cekf::Match>& matches) {
  return association::chi2_threshold(usual, std::max(1, rows_of(matches)));
}

std::vector<ContradictingName> contradicting_names(const cekf::CompressedEkf& filter,
                                                   const std::vector<cekf::Match>& matches,
                                                   const AssumedOfNames& assumed) {
  if (least_cost(filter, matches) <= assumed.noise_scale * usual_nis(matches)) return {};
  GivenOthers given(filter.innovation(matches), matches, assumed.noise_scale);
  std::vector<std::size_t> left(matches.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<ContradictingName> contradicting;
  while (!left.empty()) {
    const auto nats_for_other = [&](std::size_t i) {
      const double density = density_of_any(matches[i].observation.kind, assumed);
      return std::log(density * assumed.wrong / (1.0 - assumed.wrong)) - given.log_likelihood(i);
    };
    const auto worst = std::max_element(
        left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return nats_for_other(a) < nats_for_other(b); });
    const double nis = given.nis(*worst);
    if (!(nats_for_other(*worst) > 0.0 && nis > association::chi2_threshold(usual, given.dof(*worst)))) break;
    contradicting.push_back({*worst, nis, given.dof(*worst)});
    given.leave_out(*worst);
    left.erase(worst);
  }
  return contradicting;
}

double nats_for_slip(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                     const std::vector<ContradictingName>& contradicting, const AssumedOfNames& assumed,
                     const SlipOptions& options) {
  constexpr double slip = 1e-3, turned_rad = 5.0 * core::pi / 180.0;
  std::vector<cekf::Match> agreeing = matches;
  std::vector<std::size_t> wrong;
  for (const ContradictingName& one : contradicting) wrong.push_back(one.match);
  std::sort(wrong.rbegin(), wrong.rend());
  double without = 0.0;
  for (const std::size_t i : wrong) {
    agreeing.erase(agreeing.begin() + static_cast<std::ptrdiff_t>(i));
    without += std::log(assumed.wrong * density_of_any(matches[i].observation.kind, assumed));
  }
  if (!agreeing.empty()) without += log_likelihood(filter.innovation(agreeing), assumed.noise_scale);
  const cekf::CompressedEkf slipped = moved_by_up_to(filter, options.middle_m, turned_rad);
  return std::log(slip) + log_likelihood(slipped.innovation(matches), assumed.noise_scale) - without;
}

bool agree_about_a_pose(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                        const AssumedOfNames& assumed) {
  constexpr double turned_rad = 0.25 * core::pi;
  if (rows_of(matches) <= 3) return false;
  const cekf::CompressedEkf anywhere =
      moved_by_up_to(filter, assumed.view.reach().value_or(assumed.reach_m), turned_rad);
  return least_cost(anywhere, matches) <= assumed.noise_scale * usual_nis(matches);
}

ContradictedName contradicted_name(const cekf::CompressedEkf& filter, const cekf::Match& match,
                                   const core::FieldOfView& view, core::LandmarkId landmark) {
  ContradictedName name;
  name.landmark = landmark;
  const core::PoseGaussian pose = filter.pose();
  if (core::dimension(match.observation.kind) == 2) {
    const core::LocatedLandmark seen = core::locate_landmark(match.observation, pose.mean, match.T_robot_sensor);
    const Eigen::Matrix2d covariance_m2 = seen.G_pose * pose.covariance * seen.G_pose.transpose() +
                                          seen.G_z * Eigen::Matrix2d(match.observation.R) * seen.G_z.transpose();
    name.seen_at = core::PointGaussian{seen.point_world_m, covariance_m2};
    return name;
  }
  const core::Pose2 T_world_sensor = core::compose(pose.mean, match.T_robot_sensor);
  const Eigen::Vector2d mapped_m = core::transform(core::inverse(T_world_sensor), filter.landmark_mean(match.landmark));
  name.is_in_view =
      mapped_m.norm() <= view.max_range_m && core::is_between_bearings(view, std::atan2(mapped_m.y(), mapped_m.x()));
  return name;
}

}  // namespace helixnav::supervisor
