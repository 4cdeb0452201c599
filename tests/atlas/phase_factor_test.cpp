// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "phase/world_form.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// χ² of a log at a shape, and its normal equations over all poses and points, without central differences: the
/// residuals' Jacobians are written out again here, dense.
struct Dense {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  double chi2 = 0.0;
};

Eigen::Vector3d motion_residual(const core::Pose2& from, const core::Pose2& to, const LoggedStep& step) {
  Eigen::Vector3d r = step.T_before_after.vector() - core::between(from, to).vector();
  r[2] = core::wrap_to_pi(r[2]);
  return r;
}

Dense dense_equations(const PhaseLog& log, const PhaseShape& shape) {
  const Index T = static_cast<Index>(log.steps.size());
  const Index n = 3 * T + 2 * static_cast<Index>(shape.ids.size());
  Dense dense{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  const auto pose = [&shape](Index k) {
    return k == 0 ? core::Pose2() : shape.T_entry_robot[static_cast<std::size_t>(k - 1)];
  };
  const auto add = [&dense](const Eigen::MatrixXd& J, const Eigen::VectorXd& r, const Eigen::MatrixXd& W) {
    dense.H += J.transpose() * W * J;
    dense.b += J.transpose() * W * r;
    dense.chi2 += r.dot(W * r);
  };
  for (Index k = 1; k <= T; ++k) {
    const LoggedStep& step = log.steps[static_cast<std::size_t>(k - 1)];
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, n);
    for (int i = 0; i < 6; ++i) {
      Eigen::Vector3d from = pose(k - 1).vector(), to = pose(k).vector(), from2 = from, to2 = to;
      const double h = 1e-5;
      (i < 3 ? from : to)[i % 3] += h;
      (i < 3 ? from2 : to2)[i % 3] -= h;
      const Index column = 3 * (k - 1 - (i < 3 ? 1 : 0)) + i % 3;
      if (column < 0) continue;
      J.col(column) = -(motion_residual(core::Pose2(from), core::Pose2(to), step) -
                        motion_residual(core::Pose2(from2), core::Pose2(to2), step)) /
                      (2 * h);
    }
    add(J, motion_residual(pose(k - 1), pose(k), step), step.covariance.inverse());
  }
  for (Index k = 0; k <= T; ++k) {
    for (const SeenLandmark& seen : k == 0 ? log.seen_at_entry : log.steps[static_cast<std::size_t>(k - 1)].seen) {
      const auto place = std::lower_bound(shape.ids.begin(), shape.ids.end(), seen.id) - shape.ids.begin();
      const auto& z = seen.observation;
      const auto h = core::predict_observation(z.kind, pose(k), seen.T_robot_sensor,
                                               shape.points_m[static_cast<std::size_t>(place)]);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(h.z_hat.size(), n);
      if (k > 0) J.middleCols<3>(3 * (k - 1)) = h.H_pose;
      J.middleCols<2>(3 * T + 2 * place) = h.H_landmark;
      add(J, core::innovation(z.kind, z.z, h.z_hat), z.R.inverse());
    }
  }
  return dense;
}

TEST(PhaseFactor, IsTheSchurComplementOfTheInteriorPoses) {
  const testing::SmallDrive drive = testing::make_small_drive(1);
  for (const std::size_t phase : {0u, 3u, 7u}) {
    const PhaseLog& log = *drive.logs[phase];
    const PhaseFactor factor = derive_factor(log, dead_reckon(log));
    const Dense dense = dense_equations(log, factor.shape);
    const Index inner = 3 * (static_cast<Index>(log.steps.size()) - 1);
    const Index kept = dense.H.rows() - inner;
    const Eigen::MatrixXd W = dense.H.topLeftCorner(inner, inner).inverse() * dense.H.topRightCorner(inner, kept);
    const Eigen::MatrixXd Lambda = dense.H.bottomRightCorner(kept, kept) - dense.H.bottomLeftCorner(kept, inner) * W;
    const Eigen::VectorXd eta = dense.b.tail(kept) - W.transpose() * dense.b.head(inner);
    EXPECT_LT((factor.gaussian.information.full() - Lambda).cwiseAbs().maxCoeff(), 1e-9 * Lambda.cwiseAbs().maxCoeff());
    // Gauss–Newton has converged: what is left of η is rounding of terms of the order of Λ times metres.
    EXPECT_LT((factor.gaussian.vector - eta).cwiseAbs().maxCoeff(), 1e-9 * Lambda.cwiseAbs().maxCoeff());
    EXPECT_NEAR(
        factor.gaussian.chi2,
        dense.chi2 - dense.b.head(inner).dot(dense.H.topLeftCorner(inner, inner).inverse() * dense.b.head(inner)),
        1e-8);
  }
}

TEST(PhaseFactor, OfOneStepThatSeesManyLandmarksHasNothingToEliminate) {
  core::RandomStream random(5);
  PhaseLog log;
  log.steps.push_back({core::Pose2(5.0, 0.0, 0.1), 0.01 * Eigen::Matrix3d::Identity(), {}});
  for (core::LandmarkId id = 0; id < 60; ++id) {  // as in a forest: Eigen blocks products of this size
    const Eigen::Vector2d point_m(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0));
    const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
    log.seen_at_entry.push_back({id, {}, core::make_cartesian(point_m, R)});
    const Eigen::Vector2d later_m = core::transform(core::inverse(log.steps[0].T_before_after), point_m);
    log.steps[0].seen.push_back({id, {}, core::make_cartesian(later_m, R)});
  }
  const PhaseFactor factor = derive_factor(log, dead_reckon(log));
  const Dense dense = dense_equations(log, factor.shape);
  EXPECT_LT((factor.gaussian.information.full() - dense.H).cwiseAbs().maxCoeff(), 1e-9 * dense.H.cwiseAbs().maxCoeff());
}

TEST(PhaseFactor, SaysTheSameAtAnyRigidMotion) {
  const testing::SmallDrive drive = testing::make_small_drive(2);
  const PhaseLog& log = *drive.logs[2];
  const PhaseFactor factor = derive_factor(log, dead_reckon(log));
  core::RandomStream random(3);
  Values at{Eigen::Vector3d(0.3, -0.2, 0.1)};
  at.push_back(
      core::compose(core::Pose2(at[0]), core::Pose2(Eigen::Vector3d(factor.gaussian.mean.head<3>()))).vector() +
      Eigen::Vector3d(0.2, -0.1, 0.02));
  for (const auto& point_m : factor.shape.points_m)
    at.emplace_back(point_m.x() + random.normal(0.0, 0.3), point_m.y(), 0.0);
  const Eigen::MatrixXd here = world_form(factor.gaussian, at);
  const Index n = here.rows() - 1;
  const Eigen::MatrixXd A = here.selfadjointView<Eigen::Lower>();
  for (int trial = 0; trial < 100; ++trial) {
    const core::Pose2 g(random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3), random.uniform(-3.0, 3.0));
    Values moved;
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
    Index row = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      moved.push_back(i < 2 ? core::compose(g, core::Pose2(at[i])).vector() : Eigen::Vector3d::Zero().eval());
      if (i >= 2) moved[i].head<2>() = core::transform(g, at[i].head<2>());
      D.block<2, 2>(row, row) = core::rotation(g.heading_rad);
      row += i < 2 ? 3 : 2;
    }
    const Eigen::MatrixXd there = Eigen::MatrixXd(world_form(factor.gaussian, moved).selfadjointView<Eigen::Lower>());
    const double scale = A.topLeftCorner(n, n).cwiseAbs().maxCoeff();
    EXPECT_LT((there.topLeftCorner(n, n) - D * A.topLeftCorner(n, n) * D.transpose()).cwiseAbs().maxCoeff(),
              1e-9 * scale);
    EXPECT_LT((there.row(n).head(n).transpose() - D * A.row(n).head(n).transpose()).cwiseAbs().maxCoeff(),
              1e-9 * scale);
    EXPECT_NEAR(there(n, n), A(n, n), 1e-9 * std::abs(A(n, n)) + 1e-9 * scale);
    Eigen::MatrixXd gauge = Eigen::MatrixXd::Zero(n, 3);
    row = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      gauge.middleRows<2>(row) << 1.0, 0.0, -(moved[i] - moved[0]).y(), 0.0, 1.0, (moved[i] - moved[0]).x();
      if (i < 2) gauge(row + 2, 2) = 1.0;
      row += i < 2 ? 3 : 2;
    }
    EXPECT_LT((there.topLeftCorner(n, n) * gauge).cwiseAbs().maxCoeff(), 1e-9 * scale);
  }
}

TEST(PhaseFactor, IsRefusedForALogThatCannotBe) {
  testing::SmallDrive drive = testing::make_small_drive(4);
  PhaseLog log = *drive.logs[1];
  const PhaseShape shape = dead_reckon(log);
  log.steps[2].covariance(2, 2) = 0.0;
  EXPECT_THROW(derive_factor(log, shape), core::PreconditionError);
  EXPECT_THROW(derive_factor(PhaseLog(), PhaseShape()), core::PreconditionError);
  EXPECT_THROW(derive_factor(*drive.logs[0], shape), core::PreconditionError);
}

TEST(PhaseFactor, WithAnUndeterminedLandmarkStaysOutsideAndLeavesTheAtlasAsItWas) {
  testing::SmallDrive drive = testing::make_small_drive(5);
  Atlas atlas = testing::driven(drive);
  PhaseLog log = *drive.logs[1];
  log.steps[3].seen.push_back({77, core::Pose2(), core::make_range(5.0, 0.1)});
  try {
    atlas.add(derive_factor(log, dead_reckon(log)));
    FAIL() << "nothing thrown";
  } catch (const core::NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find(" 77"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(atlas.is_settled());
  EXPECT_EQ(atlas.phase_count(), static_cast<int>(drive.logs.size()));
}

}  // namespace
}  // namespace helixnav::atlas
