// SPDX-License-Identifier: BSD-3-Clause
#include "update/iterate.hpp"

#include <limits>

#include <Eigen/Cholesky>

namespace helixnav::cekf {
namespace {

using Index = Eigen::Index;

/// First rows of the points among what is involved: the vehicle's position, then the landmarks.
template <class Action>
void for_each_point(Index involved, const Action& action) {
  action(Index{0});
  for (Index column = 3; column < involved; column += 2) action(column);
}

}  // namespace

InvolvedCorrection::InvolvedCorrection(Retraction retraction, const UpdateWorkspace& w)
    : retraction_(retraction),
      pose_(w.pose),
      points_m_(w.points_m),
      gain_(Eigen::VectorXd::Zero(static_cast<Index>(w.involved.size()))),
      delta_(gain_) {}

void InvolvedCorrection::go_towards(const InvolvedCorrection& from, double fraction, const UpdateWorkspace& w) {
  gain_ = from.gain_ + fraction * (w.gain.view().col(0) - from.gain_);
  delta_ = w.P.view() * gain_;
}

double InvolvedCorrection::rounding(const UpdateWorkspace& w) const {
  const double of_a_product = static_cast<double>(gain_.size()) * std::numeric_limits<double>::epsilon();
  return of_a_product * (w.P.view().cwiseAbs() * gain_.cwiseAbs()).maxCoeff();
}

double InvolvedCorrection::cost(const UpdateWorkspace& w) const {
  const Eigen::LLT<Eigen::MatrixXd> R(w.R.view());
  if (R.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return gain_.dot(delta_) + R.matrixL().solve(w.nu.view().col(0)).squaredNorm();
}

void InvolvedCorrection::place(UpdateWorkspace& w) const {
  const Eigen::Matrix2d V =
      retraction_ == Retraction::standard ? Eigen::Matrix2d(Eigen::Matrix2d::Identity()) : turning_average(delta_[2]);
  const Eigen::Vector2d position_m = pose_.position_m() + V * delta_.head<2>();
  w.pose = core::Pose2(position_m.x(), position_m.y(), pose_.heading_rad + delta_[2]);
  for (std::size_t i = 0; i < points_m_.size(); ++i) {
    w.points_m[i] = points_m_[i] + V * delta_.segment<2>(3 + 2 * static_cast<Index>(i));
  }
}

void InvolvedCorrection::refer_to_delta(UpdateWorkspace& w) const {
  auto H = w.H.view();
  if (retraction_ == Retraction::right_invariant) {
    const Eigen::Matrix2d V = turning_average(delta_[2]);
    const Eigen::Matrix2d dV = turning_average_derivative(delta_[2]);
    for_each_point(H.cols(), [&](Index column) {
      const Eigen::MatrixXd by_point = H.middleCols<2>(column);
      H.col(2) += by_point * (dV * delta_.segment<2>(column));
      H.middleCols<2>(column) = by_point * V;
    });
  }
  w.nu.view().col(0) += H * delta_;
}

void InvolvedCorrection::refer_to_transported_errors(UpdateWorkspace& w) const {
  if (retraction_ == Retraction::standard) return;
  const Eigen::Matrix2d V = turning_average(delta_[2]);
  auto H = w.H.view();
  for_each_point(H.cols(), [&](Index column) {
    const Eigen::Vector2d moved_m = V * delta_.segment<2>(column);
    H.col(2) += H.middleCols<2>(column) * quarter_turn(moved_m);
  });
}

std::vector<double> cost_by_part(const UpdateWorkspace& w, const std::vector<int>& rows_of_part) {
  const Eigen::MatrixXd L = w.L.view().triangularView<Eigen::Lower>();
  const Eigen::VectorXd lambda = L.transpose().triangularView<Eigen::Upper>().solve(w.y.view().col(0));
  const Eigen::MatrixXd S = L * L.transpose();
  std::vector<double> parts;
  Index row = 0;
  for (const int rows : rows_of_part) {
    parts.push_back(lambda.segment(row, rows).dot(S.block(row, row, rows, rows) * lambda.segment(row, rows)));
    row += rows;
  }
  return parts;
}

}  // namespace helixnav::cekf
