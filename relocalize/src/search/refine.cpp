// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "search/hypothesis.hpp"
#include "search/pairing.hpp"

namespace helixnav::relocalize {

namespace {

/// The nearest landmark within reach of a point; ties are broken by id.
Slot nearest_landmark(const Prepared& asked, const core::Pose2& T, const Point& point, double radius_m) {
  const Eigen::Vector2f at = laid(T, point);
  Slot best = no_slot;
  float best_m2 = std::numeric_limits<float>::infinity();
  asked.map.grid.within(asked.map.nodes, at.x(), at.y(), static_cast<float>(radius_m), [&](Slot slot, float d2_m2) {
    const bool nearer =
        d2_m2 < best_m2 || (d2_m2 == best_m2 && asked.map.details[slot].id < asked.map.details[best].id);
    if (!nearer) return;
    best = slot;
    best_m2 = d2_m2;
  });
  return best;
}

/// The likeliest landmark for a point within the gate of a pair.
Slot likeliest_landmark(const Prepared& asked, const core::Pose2& T, std::size_t point) {
  Pairable best;
  best.chi2 = std::numeric_limits<double>::infinity();
  for_each_pairable(asked, T, point, [&](const Pairable& pairable) {
    if (pairable < best) best = pairable;
  });
  return best.match.slot;
}

}  // namespace

Difference difference(const Prepared& asked, const core::Pose2& T_origin_centre, const Match& match) {
  const Point& point = asked.points[match.point];
  const Node& node = asked.map.nodes[match.slot];
  const Detail& detail = asked.map.details[match.slot];
  Difference result;
  result.value_m =
      Eigen::Vector2d(node.x_m, node.y_m) - core::transform(T_origin_centre, Eigen::Vector2d(point.x_m, point.y_m));
  result.covariance_m2 << detail.xx_m2, detail.xy_m2, detail.xy_m2, detail.yy_m2;
  const Eigen::Matrix2d turn = core::rotation(T_origin_centre.heading_rad);
  result.covariance_m2 += turn * asked.question.landmarks[match.point].point.covariance_m2 * turn.transpose();
  return result;
}

bool step_pose(const Prepared& asked, const std::vector<Match>& matches, double blur_m2, core::Pose2& T_origin_centre,
               Eigen::Matrix3d& information) {
  information.setZero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  const Eigen::Matrix2d turn = core::rotation(T_origin_centre.heading_rad);
  for (const Match& match : matches) {
    Difference d = difference(asked, T_origin_centre, match);
    d.covariance_m2.diagonal().array() += blur_m2;
    const Point& point = asked.points[match.point];
    Eigen::Matrix<double, 2, 3> J;
    J.leftCols<2>().setIdentity();
    J.col(2) = turn * Eigen::Vector2d(-point.y_m, point.x_m);
    const Eigen::Matrix<double, 3, 2> weighted = J.transpose() * d.covariance_m2.inverse();
    information += weighted * J;
    gradient += weighted * d.value_m;
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(information);
  if (matches.size() < 2 || factor.info() != Eigen::Success || !factor.isPositive()) return false;
  T_origin_centre = core::Pose2(T_origin_centre.vector() + factor.solve(gradient));
  return true;
}

void refine(const Prepared& asked, const std::vector<double>& shares, core::Pose2& T_origin_centre) {
  std::vector<Match> matches;
  Eigen::Matrix3d information;
  for (const double share : shares) {
    matches.clear();
    for (std::size_t i = 0; i < asked.points.size(); ++i) {
      const Slot slot = share > 0.0 ? nearest_landmark(asked, T_origin_centre, asked.points[i], share * asked.near_m)
                                    : likeliest_landmark(asked, T_origin_centre, i);
      if (slot != no_slot) matches.push_back({i, slot});
    }
    if (matches.size() < 3) return;
    const double blur_m = 0.3 * share * asked.near_m;
    if (!step_pose(asked, matches, blur_m * blur_m, T_origin_centre, information)) return;
  }
}

}  // namespace helixnav::relocalize
