// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/systematic_learner.hpp"

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using Vector = SystematicErrors::Vector;
using Matrix = SystematicErrors::Matrix;

/// A stretch that knows each error to `sigmas`, whose measurements are displaced by as many of their own standard deviations
/// as there are sigmas in an error.
StretchEvidence stretch(const Vector& errors, const Vector& sigmas) {
  StretchEvidence evidence;
  evidence.information = sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
  evidence.gradient = evidence.information * errors;
  evidence.in_rows = evidence.information.diagonal() * 10.0;
  evidence.motions = evidence.sightings = 10;
  evidence.dof = 100;
  evidence.chi2 = 100.0 + errors.dot(evidence.gradient);
  return evidence;
}

Vector sigmas() { return (Vector() << 0.01, 0.01, 0.01, 0.01, 0.1).finished(); }

SystematicLearner after(int stretches, const StretchEvidence& each) {
  SystematicLearner learner;
  for (int i = 0; i < stretches; ++i) learner.add(each);
  return learner;
}

TEST(SystematicLearner, TakesOnlyWhatIsCertain) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.001, 0.0, -0.5).finished();
  SystematicLearner learner = after(4, stretch(errors, sigmas()));
  const auto certain = learner.certain();
  ASSERT_TRUE(certain);
  EXPECT_NEAR(certain->errors.too_long, 0.04 / 0.96, 1e-9) << "4 % of the measured distances";
  EXPECT_NEAR(certain->errors.short_m, -0.5, 1e-9);
  EXPECT_EQ(certain->errors.turn_rad_per_m, 0.0) << "0.2 standard deviations";
  EXPECT_NEAR(certain->nats, 0.5 * 4.0 * (16.0 + 25.0), 1e-6);
}

TEST(SystematicLearner, IsNotAskedOfThreeStretchesNorOfSmallErrors) {
  const Vector errors = (Vector() << 0.0, 0.0, 0.0, 0.08, 0.0).finished();
  EXPECT_FALSE(after(3, stretch(errors, sigmas())).certain());
  EXPECT_TRUE(after(4, stretch(errors, sigmas())).certain());
  const Vector small = 0.025 * errors;  // a fifth of a standard deviation of a measurement
  EXPECT_FALSE(after(2000, stretch(small, sigmas())).certain());
  EXPECT_TRUE(after(2000, stretch(2.0 * small, sigmas())).certain());
}

TEST(SystematicLearner, ErrorsTakenOutAreNoLongerThere) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.0, 0.0, 0.0).finished();
  SystematicLearner learner = after(8, stretch(errors, sigmas()));
  learner.take_out(learner.certain()->errors);
  EXPECT_NEAR(learner.taken_out().too_long, 0.04 / 0.96, 1e-9);
  for (int i = 0; i < 8; ++i) learner.add(stretch(Vector::Zero(), sigmas()));
  EXPECT_FALSE(learner.certain());
}

// A steering offset that changes: four stretches of 0.04, taken out, and then its opposite.
TEST(SystematicLearner, PutsBackWhatLaterStretchesContradict) {
  const Vector errors = (Vector() << 0.0, 0.0, 0.04, 0.0, 0.5).finished();
  SystematicLearner learner = after(4, stretch(errors, sigmas()));
  learner.take_out(learner.certain()->errors);
  EXPECT_FALSE(learner.contradicted());
  const Vector opposite = (Vector() << 0.0, 0.0, -0.08, 0.0, 0.0).finished();  // of what was taken out
  int stretches = 0;
  while (!learner.contradicted() && stretches < 20) {
    learner.add(stretch(opposite, sigmas()));
    ++stretches;
  }
  EXPECT_EQ(stretches, 4);
  learner.give_up(learner.contradicted()->errors);
  EXPECT_EQ(learner.taken_out().turn_rad_per_m, 0.0);
  EXPECT_NEAR(learner.taken_out().short_m, 0.5, 1e-9) << "which nothing contradicts";
  for (int i = 0; i < 64; ++i) {
    learner.add(stretch(-1.0 * errors.cwiseProduct(Vector::Unit(2)), sigmas()));
    EXPECT_FALSE(learner.contradicted());
  }
  EXPECT_FALSE(learner.certain()) << "given up";
}

TEST(SystematicLearner, KeepsWhatIsSmallerOrLargerLater) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.04, 0.0, 0.0).finished();
  SystematicLearner learner = after(4, stretch(errors, sigmas()));
  learner.take_out(learner.certain()->errors);
  const Vector changed = (Vector() << 0.02, 0.0, -0.015, 0.0, 0.0).finished();
  for (int i = 0; i < 64; ++i) {
    learner.add(stretch(changed, sigmas()));
    EXPECT_FALSE(learner.contradicted()) << i;
  }
}

TEST(SystematicLearner, IsMadeMorePreciseByWhatIsLeft) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.0, 0.0, 0.0).finished();
  SystematicLearner learner = after(8, stretch(errors, sigmas()));
  learner.take_out(learner.certain()->errors);
  const Vector left = (Vector() << 0.02, 0.0, 0.0, 0.0, 0.0).finished();
  for (int i = 0; i < 24; ++i) learner.add(stretch(left, sigmas()));
  const auto again = learner.certain();
  ASSERT_TRUE(again);
  learner.take_out(again->errors);
  EXPECT_NEAR(learner.taken_out().too_long, 1.0 / 0.96 / 0.985 - 1.0, 1e-9) << "24 of 32 stretches say 2 % more";
}

TEST(SystematicLearner, AsksAgainWhenTwiceAsMuchIsKnown) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.0, 0.0, 0.0).finished();
  SystematicLearner learner = after(4, stretch(errors, sigmas()));
  ASSERT_TRUE(learner.certain());
  for (int stretches = 5; stretches <= 8; ++stretches) {
    learner.add(stretch(errors, sigmas()));
    EXPECT_EQ(learner.certain().has_value(), stretches == 8) << stretches;
  }
}

/// Of two errors that have the same effect, it takes one or a part of each, not two that cancel.
TEST(SystematicLearner, DoesNotTellApartWhatCannotBe) {
  StretchEvidence evidence = stretch((Vector() << 0.0, 0.04, 0.0, 0.0, 0.0).finished(), sigmas());
  evidence.information.row(2) = evidence.information.row(1);
  evidence.information.col(2) = evidence.information.col(1);
  evidence.information(2, 2) = evidence.information(1, 1);
  evidence.gradient(2) = evidence.gradient(1);
  const auto certain = after(4, evidence).certain();
  ASSERT_TRUE(certain);
  EXPECT_NEAR(certain->errors.turn_rad_per_s + certain->errors.turn_rad_per_m, 0.04, 1e-9);
  EXPECT_GE(certain->errors.turn_rad_per_s, 0.0);
  EXPECT_GE(certain->errors.turn_rad_per_m, 0.0);
}

/// An error that begins on the way is not one that is always the same.
TEST(SystematicLearner, LeavesWhatBeginsOnTheWay) {
  const Vector errors = (Vector() << 0.0, 0.0, 0.0, 0.06, 0.0).finished();
  for (const int before : {3, 8, 20}) {
    SystematicLearner learner = after(before, stretch(Vector::Zero(), sigmas()));
    for (int i = 0; i < before; ++i) {
      learner.add(stretch(errors, sigmas()));
      EXPECT_FALSE(learner.certain()) << before << ", " << i;
    }
  }
}

/// Stretches that contradict each other more than their covariances say are believed less.
TEST(SystematicLearner, ScatterCounts) {
  const Vector errors = (Vector() << 0.04, 0.0, 0.0, 0.0, 0.0).finished();
  const Vector scattered = (Vector() << 0.08, 0.1, -0.1, 0.1, 1.0).finished();
  EXPECT_TRUE(after(8, stretch(errors, sigmas())).certain());
  SystematicLearner learner;
  for (int i = 0; i < 8; ++i) learner.add(stretch(errors + (i % 2 == 0 ? scattered : Vector(-scattered)), sigmas()));
  EXPECT_FALSE(learner.certain());
}

StretchEvidence closing_that_says(double turn_rad_per_s, double sigma_rad_per_s) {
  StretchEvidence evidence;
  evidence.information(1, 1) = 1.0 / (sigma_rad_per_s * sigma_rad_per_s);
  evidence.gradient(1) = evidence.information(1, 1) * turn_rad_per_s;
  evidence.dof = 20;
  evidence.chi2 = 20.0 + turn_rad_per_s * evidence.gradient(1);
  return evidence;
}

/// Odometry may also not fit a closing because its noise is larger than assumed.
TEST(SystematicLearner, AClosingCountsWithStretchesThatHaveTheError) {
  const double bias = 0.01;
  Vector errors = Vector::Zero();
  errors(1) = bias;
  for (const double stretches_know : {1.9, 3.1}) {  // the error, in standard deviations
    SystematicLearner learner = after(9, stretch(errors, Vector::Constant(3.0 * bias / stretches_know)));
    EXPECT_FALSE(learner.certain());
    learner.add_closing(closing_that_says(bias, bias / 5.0));
    const auto certain = learner.certain_after_closing();
    ASSERT_EQ(certain.has_value(), stretches_know > 2.0);
    if (certain.has_value()) {
      EXPECT_NEAR(certain->errors.turn_rad_per_s, bias, 1e-9);
    }
  }
  SystematicLearner alone = after(9, stretch(Vector::Zero(), sigmas()));
  alone.add_closing(closing_that_says(bias, bias / 20.0));
  EXPECT_FALSE(alone.certain_after_closing()) << "twenty standard deviations, of which the stretches know nothing";
}

TEST(SystematicLearner, AClosingMakesAKnownErrorMorePrecise) {
  Vector errors = Vector::Zero();
  errors(1) = 0.04;
  SystematicLearner learner = after(4, stretch(errors, sigmas()));
  learner.take_out(learner.certain()->errors);
  learner.add_closing(closing_that_says(-0.006, 0.001));
  const auto more = learner.certain_after_closing();
  ASSERT_TRUE(more);
  EXPECT_NEAR(more->errors.turn_rad_per_s, -0.006 / (1.0 + 4.0 * 0.01), 1e-5) << "of four stretches' sigma of 0.005";
  learner.take_out(more->errors);
  EXPECT_NEAR(learner.taken_out().turn_rad_per_s, 0.034, 0.001);
  EXPECT_FALSE(learner.certain_after_closing());
}

}  // namespace
}  // namespace helixnav::supervisor
