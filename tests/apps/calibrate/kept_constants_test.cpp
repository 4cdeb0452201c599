// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/kept_constants.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

smoothing::ConstantsEvidence evidence_at(const Eigen::MatrixXd& information, const Eigen::VectorXd& minimum) {
  return {-information * minimum, information};
}

const Eigen::Vector2d usual(1.0, 1.0), told(0.0, 0.0);

// The first is 5 standard deviations from its given value, the second 1: its interval contains the given value.
TEST(KeptConstants, GoBackToToldWhereTheIntervalHoldsIt) {
  const Eigen::Matrix2d S = Eigen::Vector2d(100.0, 100.0).asDiagonal();
  const auto all = evidence_at(S, Eigen::Vector2d(0.5, 0.1));
  const std::vector<Fold> folds{{all, all}};
  const auto verdicts = judge_kept(all, folds, {Verdict::kept, Verdict::kept}, usual, told);
  EXPECT_EQ(verdicts, (std::vector<Verdict>{Verdict::kept, Verdict::indistinguishable}));
}

// If two are hardly distinguishable, neither interval excludes the given value; with one held there, the other's does.
TEST(KeptConstants, AreJudgedWithTheOthersThatWentBackAsTold) {
  Eigen::Matrix2d S;
  S << 100.0, 99.0, 99.0, 100.0;
  const auto all = evidence_at(S, Eigen::Vector2d(0.5, 0.1));
  const auto verdicts = judge_kept(all, {{all, all}}, {Verdict::kept, Verdict::kept}, usual, told);
  EXPECT_EQ(verdicts, (std::vector<Verdict>{Verdict::kept, Verdict::indistinguishable}));
  EXPECT_NEAR(kept_sigmas(S, verdicts, usual)[0], 0.1, 1e-6);
}

TEST(KeptConstants, AreConfirmedByWhatIsHeldOut) {
  const Eigen::Matrix2d S = Eigen::Vector2d(100.0, 100.0).asDiagonal();
  const auto all = evidence_at(S, Eigen::Vector2d(0.5, 0.5));
  const std::vector<Fold> folds{{all, evidence_at(S, Eigen::Vector2d(0.5, -0.5))}};
  const auto verdicts = judge_kept(all, folds, {Verdict::kept, Verdict::kept}, usual, told);
  EXPECT_EQ(verdicts, (std::vector<Verdict>{Verdict::kept, Verdict::not_confirmed}));
}

// Delays of logs on parallel strips: 0.20 s that is not there, 11.6 standard deviations from 0; 0.15 s that is, 4.4 from 0.
TEST(KeptConstants, GainWhatTheirDerivativePromises) {
  EXPECT_FALSE(gains_as_promised(5079.2 - 5089.8, 11.6));
  EXPECT_TRUE(gains_as_promised(1149.0 - 1084.0, 4.4));
}

}  // namespace
}  // namespace helixnav::apps
