// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "atlas_access.hpp"
#include "campaign.hpp"
#include "cut_problem.hpp"
#include "helixnav/smoothing/marginals.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

/// Rounds on one circle, of 6⅛ phases each, so that no phase begins where one of the previous round did.
testing::SmallDrive rounds(std::uint64_t seed, int count, double noise) {
  testing::SmallDriveOptions options;
  options.rounds = count;
  options.steps = 49 * count;
  options.noise = noise;
  return testing::make_small_drive(seed, options);
}

Atlas condensed_drive(const testing::SmallDrive& drive, int laps_kept) {
  Options options;
  options.laps_kept = laps_kept;
  Atlas atlas({}, options);
  for (const auto& log : drive.logs) {
    testing::add_phase(atlas, log);
    if (atlas.condense() > 0) atlas.settle();
  }
  return atlas;
}

std::vector<core::LandmarkId> all_of(const Atlas& atlas) {
  std::vector<core::LandmarkId> ids;
  for (const Place& place : atlas.landmarks()) ids.push_back(place.id);
  return ids;
}

TEST(Condense, TakesInformationAwayAndNeverAddsAny) {
  const testing::SmallDrive drive = rounds(31, 8, 0.0);  // no noise: both are linearised at the truth
  const Atlas whole = testing::driven(drive, Options());
  const Atlas condensed = condensed_drive(drive, 1);
  EXPECT_GT(condensed.size().condensed, 20);
  const Eigen::MatrixXd exact = whole.joint(all_of(whole)).covariance;
  const Eigen::MatrixXd wider = condensed.joint(all_of(whole)).covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> lost(wider - exact);
  EXPECT_GT(lost.eigenvalues()[0], -1e-8 * exact.trace());
  EXPECT_LT(wider.trace(), 1.5 * exact.trace());  // most of it is kept
}

TEST(Condense, EqualsTheBatchOfTheProblemThatIsCutInTheSamePlaces) {
  const testing::SmallDrive drive = rounds(32, 5, 1e-4);  // so little noise that nothing is distorted
  const Atlas atlas = condensed_drive(drive, 1);
  smoothing::Problem cut = testing::cut_problem(drive, AtlasAccess::settled(atlas));
  EXPECT_GT(cut.graph.poses.size(), drive.problem.graph.poses.size() + 10);
  testing::solve(cut);
  const std::vector<core::LandmarkId> ids = all_of(atlas);
  std::vector<int> indices;
  for (const core::LandmarkId id : ids) indices.push_back(testing::index_of_landmark(cut, id));
  const int last = static_cast<int>(drive.problem.graph.poses.size()) - 1;
  const Eigen::MatrixXd exact = smoothing::joint_covariance(cut, {last}, indices);
  const core::JointGaussian joint = atlas.joint(ids);
  EXPECT_LT((joint.covariance - exact).cwiseAbs().maxCoeff(), 1e-6 * exact.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Eigen::Vector2d& point_m = cut.graph.landmarks[static_cast<std::size_t>(indices[i])].point_m;
    EXPECT_LT((joint.points_m[i] - point_m).norm(), 1e-8);
  }
}

TEST(Condense, BoundsWhatGroundCostsThatIsDrivenAgainAndAgain) {
  const testing::SmallDrive drive = rounds(33, 30, 1.0);
  Options options;
  options.laps_kept = 2;
  Atlas atlas({}, options);
  std::vector<double> numbers;
  std::vector<int> uncondensed;
  for (std::size_t k = 0; k < drive.logs.size(); ++k) {
    testing::add_phase(atlas, drive.logs[k]);
    if (atlas.condense() > 0) atlas.settle();
    const Atlas::Size size = atlas.size();
    numbers.push_back(size.factor_nonzeros + size.message_nonzeros);
    uncondensed.push_back(size.phases - size.condensed);
  }
  const auto largest = [](const auto& values, std::size_t begin, std::size_t end) {
    return *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(begin),
                             values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  const std::size_t n = numbers.size();
  EXPECT_LE(largest(numbers, 2 * n / 3, n), 1.25 * largest(numbers, n / 3, 2 * n / 3));
  EXPECT_LE(largest(uncondensed, 2 * n / 3, n), largest(uncondensed, n / 3, 2 * n / 3) + 6);
  EXPECT_LT(uncondensed.back(), 48);
}

TEST(Condense, KeepsThePathOfTheDriveAndAllLandmarks) {
  const testing::SmallDrive drive = rounds(34, 6, 1.0);
  const Atlas atlas = condensed_drive(drive, 1);
  EXPECT_GT(atlas.size().condensed, 10);
  EXPECT_EQ(atlas.landmarks().size(), drive.problem.graph.landmarks.size());
  const std::vector<core::Pose2> clones = atlas.clones();
  for (std::size_t k = 0; k < clones.size(); ++k) {
    const core::Pose2& truth = drive.truth[static_cast<std::size_t>(drive.pose_of_clone[k])];
    EXPECT_LT((clones[k].position_m() - truth.position_m()).norm(), 0.5) << k;
    EXPECT_EQ(clones[k].position_m(), atlas.clone(static_cast<int>(k)).position_m());
  }
  for (int k = 0; k < atlas.phase_count(); ++k) {
    const core::Pose2& truth =
        drive.truth[static_cast<std::size_t>(drive.pose_of_clone[static_cast<std::size_t>(k) + 1])];
    EXPECT_LT((atlas.poses_of(k).back().position_m() - truth.position_m()).norm(), 0.5) << k;
  }
}

/// A street without landmarks between two condensed phases was tied to nothing, and the problem became unsolvable.
TEST(Condense, LeavesNoPhaseThatNothingHolds) {
  testing::SmallDriveOptions options;
  options.rounds = 8;
  options.steps = 8 * 49;
  options.steps_per_phase = 4;
  options.noise = 0.0;
  options.bare_rad = 3.5;
  const testing::SmallDrive drive = testing::make_small_drive(35, options);
  const Atlas whole = testing::driven(drive, Options());
  const Atlas condensed = condensed_drive(drive, 1);
  EXPECT_GT(condensed.size().condensed, 40);
  const int phases = condensed.phase_count();
  EXPECT_EQ(phases, whole.phase_count());
  for (int k = 0; k < phases; ++k) {
    const auto end = static_cast<std::size_t>(drive.pose_of_clone[static_cast<std::size_t>(k) + 1]);
    EXPECT_LT((condensed.poses_of(k).back().position_m() - drive.truth[end].position_m()).norm(), 1e-6) << k;
  }
  const Eigen::MatrixXd lost = condensed.joint(all_of(whole)).covariance - whole.joint(all_of(whole)).covariance;
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(lost).eigenvalues()[0], -1e-8 * lost.trace());
}

/// Seen at the end of a phase and at the beginning of the next one, a little to the side.
void add_landmark_where_begins(std::size_t phase, core::LandmarkId id, testing::SmallDrive& drive) {
  const auto pose = static_cast<std::size_t>(drive.pose_of_clone[phase]);
  const Eigen::Vector2d point_m = core::transform(drive.truth[pose], Eigen::Vector2d(1.0, 3.0));
  core::RandomStream none(1);
  const auto seen_from = [&](std::size_t k) {
    return SeenLandmark{id, core::Pose2(), testing::noisy_view(drive.truth[k], point_m, 0.0, none)};
  };
  drive.logs[phase - 1]->steps.back().seen.push_back(seen_from(pose));
  drive.logs[phase]->steps.front().seen.push_back(seen_from(pose + 1));
}

/// What only a phase and the street before it had seen went with both, and the joint estimate with it was sought for ever.
TEST(Condense, LeavesNoLandmarkThatNothingHolds) {
  testing::SmallDriveOptions options;
  options.rounds = 8;
  options.steps = 8 * 49;
  options.steps_per_phase = 4;
  options.noise = 0.0;
  options.bare_rad = 3.5;
  testing::SmallDrive drive = testing::make_small_drive(35, options);
  core::LandmarkId next = 100;
  bool is_street = false;
  for (std::size_t k = 20; k < drive.logs.size(); ++k) {
    const bool was_street = std::exchange(is_street, landmarks_of(*drive.logs[k]).empty());
    if (was_street && !is_street) add_landmark_where_begins(k, next++, drive);
  }
  ASSERT_GT(next, 103);
  const Atlas condensed = condensed_drive(drive, 1);
  EXPECT_GT(condensed.size().condensed, 40);
  const std::vector<core::LandmarkId> ids = all_of(condensed);
  EXPECT_EQ(ids.back(), next - 1);
  EXPECT_TRUE(condensed.joint(ids).covariance.allFinite());
}

/// Seen from the first two steps of a phase, and never again.
void add_passing_landmark(std::size_t phase, core::LandmarkId id, testing::SmallDrive& drive) {
  const auto pose = static_cast<std::size_t>(drive.pose_of_clone[phase]);
  const Eigen::Vector2d point_m = core::transform(drive.truth[pose], Eigen::Vector2d(1.0, 3.0));
  core::RandomStream none(1);
  for (const std::size_t step : {0u, 1u}) {
    drive.logs[phase]->steps[step].seen.push_back(
        {id, core::Pose2(), testing::noisy_view(drive.truth[pose + 1 + step], point_m, 0.0, none)});
  }
}

/// A piece of clutter in each phase would otherwise keep them all for ever.
TEST(Condense, TakesPhasesThatAloneHoldWhatIsForgotten) {
  constexpr core::LandmarkId passing = 100;
  testing::SmallDrive drive = rounds(37, 8, 0.0);
  for (std::size_t k = 0; k < drive.logs.size(); ++k) {
    add_passing_landmark(k, passing + static_cast<core::LandmarkId>(k), drive);
  }
  for (const bool forget : {false, true}) {
    Options options;
    options.laps_kept = 1;
    Atlas atlas({}, options);
    core::LandmarkId id = passing;
    for (const auto& log : drive.logs) {
      testing::add_phase(atlas, log);
      if (forget) atlas.forget(id++);
      if (atlas.condense() > 0) atlas.settle();
    }
    if (!forget) {
      EXPECT_EQ(atlas.size().condensed, 0);
      continue;
    }
    EXPECT_GT(atlas.size().condensed, 20);
    const std::vector<core::LandmarkId> ids = all_of(atlas);
    EXPECT_LT(ids.back(), passing);
    EXPECT_TRUE(atlas.joint(ids).covariance.allFinite());
    EXPECT_EQ(Atlas::from_factors(atlas.factors()).landmarks().size(), ids.size());
  }
}

/// A drive that has a map of its own in some of its phases, of which one landmark is on the first map, too; the others see old ground.
struct ApartInPhases {
  testing::SmallDrive drive;
  std::vector<MergePair> same;
  std::vector<core::LandmarkId> own;
};

ApartInPhases apart_in(const std::vector<std::size_t>& phases, testing::SmallDrive drive) {
  constexpr core::LandmarkId seen_again = 100, of_its_own = 200;
  ApartInPhases apart{std::move(drive), {}, {}};
  std::set<core::LandmarkId> again, own;
  for (std::size_t k = 0; k < apart.drive.logs.size(); ++k) {
    const bool is_apart = std::find(phases.begin(), phases.end(), k) != phases.end();
    const auto rename = [&](std::vector<SeenLandmark>& seen) {
      for (SeenLandmark& one : seen) {
        one.id += is_apart ? of_its_own : seen_again;
        (is_apart ? own : again).insert(one.id);
      }
    };
    rename(apart.drive.logs[k]->seen_at_entry);
    for (LoggedStep& step : apart.drive.logs[k]->steps) rename(step.seen);
  }
  for (const core::LandmarkId id : again) apart.same.emplace_back(id, id - seen_again);
  apart.same.emplace_back(*own.begin(), *own.begin() - of_its_own);
  apart.own.assign(std::next(own.begin()), own.end());
  return apart;
}

/// The map of eight rounds with that drive behind it; what is between the two is not known.
Atlas followed(const ApartInPhases& apart, const testing::SmallDriveOptions& rounds, int laps_kept) {
  Options options;
  options.laps_kept = laps_kept;
  Atlas map({}, options);
  for (const auto& log : testing::make_small_drive(36, rounds).logs) testing::add_phase(map, log);
  RelativeGaussian gap;
  gap.mean = core::inverse(map.pose()).vector();
  gap.vector = Eigen::Vector3d::Zero();
  gap.information = Eigen::Vector3d(1e-8, 1e-8, 0.01).asDiagonal();
  Atlas both = map.followed_by(gap, testing::driven(apart.drive, Options()));
  both.merge(apart.same);
  both.condense();
  both.settle();
  return both;
}

/// A part of the drive that only the drive itself and one landmark tie to the map was free to turn about that landmark: across the gap
/// between two drives nothing is tied, and two pieces of it held each other. The standard deviations were 100 m and more.
TEST(Condense, LeavesTiedWhatOnlyTheDriveTies) {
  testing::SmallDriveOptions options;
  options.noise = 0.0;
  options.steps_per_phase = 3;
  testing::SmallDriveOptions rounds = options;
  rounds.rounds = 8;
  rounds.steps = 8 * 49;
  options.rounds = 1;
  options.steps = 49;
  for (std::size_t last = 2; last < 10; ++last) {
    std::vector<std::size_t> phases{
        last};  // and those before, but for one that saw old ground, except in the first case
    for (std::size_t k = 0; k + 1 < last; ++k) phases.push_back(k);
    if (last == 2) phases.push_back(1);
    const ApartInPhases apart = apart_in(phases, testing::make_small_drive(36, options));
    const Atlas whole = followed(apart, rounds, 1000), condensed = followed(apart, rounds, 1);
    EXPECT_GT(condensed.size().condensed, whole.size().condensed + 40);
    const double exact = whole.joint(apart.own).covariance.trace();
    EXPECT_LT(condensed.joint(apart.own).covariance.trace(), 3.0 * exact) << "until phase " << last;
  }
}

/// NEES of three landmarks and the last pose, in the map frame. Bands are exceeded with probability 1e-4; conservative covariances
/// may bring the sum below, but not to half.
TEST(CondenseCampaign, LeavesErrorsWithinTheirCovariances) {
  double nees = 0.0;
  const int runs = support::campaign_runs(30);
  for (const std::uint64_t seed : support::campaign_seeds(200, 30)) {
    const testing::SmallDrive drive = rounds(seed, 6, 1.0);
    const Atlas atlas = condensed_drive(drive, 1);
    const std::vector<core::LandmarkId> ids{3, 14, 25};
    const core::JointGaussian joint = atlas.joint(ids);
    Eigen::VectorXd error(9);
    error.head<3>() = joint.pose.vector() - drive.truth.back().vector();
    error[2] = core::wrap_to_pi(error[2]);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto index = static_cast<std::size_t>(testing::index_of_landmark(drive.problem, ids[i]));
      error.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) =
          joint.points_m[i] - drive.problem.graph.landmarks[index].point_m;
    }
    nees += error.dot(joint.covariance.ldlt().solve(error));
  }
  const support::Band band = support::chi2_band(runs, 9, 1e-4);
  EXPECT_LT(nees, band.high);
  EXPECT_GT(nees, 0.5 * band.low);
}

}  // namespace
}  // namespace helixnav::atlas
