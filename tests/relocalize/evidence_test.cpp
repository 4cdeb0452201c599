// SPDX-License-Identifier: BSD-3-Clause
//
// Evidence, pose and information of an answer against what can be computed without any search.
#include <gtest/gtest.h>

#include <complex>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

constexpr IndexOptions evidence_index = {30.0, 0.1};

/// Seven landmarks of a map and a branch that sees five of them and a spurious one, with non-circular noise.
struct SmallCase {
  SmallCase() {
    const test::Points points = {{52.0, 41.0}, {60.5, 44.0}, {57.0, 52.5}, {48.0, 50.0},
                                 {66.0, 51.0}, {50.0, 60.0}, {61.0, 61.5}};
    core::RandomStream random(1);
    Eigen::Matrix2d covariance;
    covariance << 0.006, 0.002, 0.002, 0.003;
    map = test::landmarks(points, evidence_index.pair_noise_m);
    for (Landmark& landmark : map) landmark.point.covariance_m2 = covariance;
    const core::Pose2 T_branch_map = core::inverse(T_map_branch);
    for (const std::size_t seen : {0U, 1U, 2U, 3U, 4U}) {
      const Eigen::Vector2d noise(0.1 * random.normal(), 0.05 * random.normal());
      Landmark landmark =
          test::landmark(static_cast<int>(seen), core::transform(T_branch_map, points[seen] + noise), 0.07);
      landmark.point.covariance_m2(0, 0) = 0.009;
      question.landmarks.push_back(landmark);
    }
    question.landmarks.push_back(test::landmark(9, core::transform(T_branch_map, {56.0, 58.5}), 0.07));
    question.looked.push_back({core::transform(T_branch_map, {57.0, 51.0}), 16.0});
  }

  MapIndex index() const {
    MapIndex result(evidence_index, map);
    result.look_at({{57.0, 51.0}, 40.0});
    return result;
  }

  const core::Pose2 T_map_branch{30.0, 20.0, 0.7};
  std::vector<Landmark> map;
  Question question;
};

Eigen::Matrix2d pair_covariance(const Landmark& map, const Landmark& seen, double heading_rad) {
  const Eigen::Matrix2d R = core::rotation(heading_rad);
  return map.point.covariance_m2 + R * seen.point.covariance_m2 * R.transpose();
}

/// Mean over the shares u and d of the likelihood of all assignments at one pose, against chance.
double likelihood_ratio(const SmallCase& world, const core::Pose2& T) {
  const auto& seen = world.question.landmarks;
  const double radius_m = world.question.looked.front().radius_m;
  const double density = static_cast<double>(seen.size()) / (core::pi * radius_m * radius_m);
  // weight[m]: sum over all assignments with m pairs of Π N(map − T·seen; 0, V) / density
  std::vector<double> weight(seen.size() + 1, 0.0);
  std::vector<bool> taken(world.map.size(), false);
  const std::function<void(std::size_t, std::size_t, double)> assign = [&](std::size_t i, std::size_t pairs,
                                                                           double product) {
    if (i == seen.size()) {
      weight[pairs] += product;
      return;
    }
    assign(i + 1, pairs, product);
    for (std::size_t j = 0; j < world.map.size(); ++j) {
      const Eigen::Vector2d d = world.map[j].point.mean_m - core::transform(T, seen[i].point.mean_m);
      if (taken[j] || d.norm() > 1.5) continue;
      const Eigen::Matrix2d V = pair_covariance(world.map[j], seen[i], T.heading_rad);
      const double normal = std::exp(-0.5 * d.dot(V.inverse() * d)) / (2.0 * core::pi * std::sqrt(V.determinant()));
      taken[j] = true;
      assign(i + 1, pairs + 1, product * normal / density);
      taken[j] = false;
    }
  };
  assign(0, 0, 1.0);
  const double n = static_cast<double>(seen.size());
  double mean = 0.0;
  for (const double u : {0.3, 0.5, 0.7, 0.9})
    for (const double d : {0.3, 0.5, 0.7, 0.9})
      for (std::size_t m = 0; m < weight.size(); ++m) {
        const double pairs = static_cast<double>(m);
        const double missed = static_cast<double>(world.map.size()) - pairs;
        mean += weight[m] * std::pow(d, pairs) * std::pow(1.0 - d, missed) * std::pow(1.0 - u, n - pairs) *
                std::exp(u * n) / 16.0;
      }
  return mean;
}

TEST(Evidence, IsTheIntegralOverAllPosesOfTheSumOverAllAssignments) {
  const SmallCase world;
  const MapIndex index = world.index();
  const Answer answer = ask(index, world.question);
  ASSERT_FALSE(answer.places.empty());
  const Place& best = answer.places.front();
  ASSERT_EQ(best.pairs.size(), 5U);
  EXPECT_EQ(best.unmatched, 1);
  EXPECT_EQ(best.missed, 2);
  // A grid of ±4.5 σ along the principal axes of the pose.
  const Eigen::Matrix3d root = Eigen::Matrix3d(best.information.inverse()).llt().matrixL();
  constexpr int half = 8;
  constexpr double step = 4.5 / half;
  double sum = 0.0;
  for (int a = -half; a <= half; ++a)
    for (int b = -half; b <= half; ++b)
      for (int c = -half; c <= half; ++c)
        sum +=
            likelihood_ratio(world, core::Pose2(best.T_map_branch.vector() + root * (step * Eigen::Vector3d(a, b, c))));
  const double integral = sum * std::pow(step, 3) * root.determinant();
  EXPECT_NEAR(best.evidence, std::log(integral / (2.0 * core::pi * index.looked_at_m2())), 0.05);
}

TEST(Evidence, HasTheInformationOfItsPairsOnTheBranchsPose) {
  const SmallCase world;
  const Place best = ask(world.index(), world.question).places.front();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double chi2 = 0.0;
  for (const Pair& pair : best.pairs) {
    const Landmark& map = world.map[static_cast<std::size_t>(pair.map)];
    const Landmark& seen = world.question.landmarks[static_cast<std::size_t>(pair.branch)];
    Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
    J.leftCols<2>().setIdentity();
    const Eigen::Vector2d turned = core::rotation(best.T_map_branch.heading_rad) * seen.point.mean_m;
    J.col(2) = Eigen::Vector2d(-turned.y(), turned.x());
    const Eigen::Matrix2d W = pair_covariance(map, seen, best.T_map_branch.heading_rad).inverse();
    const Eigen::Vector2d d = map.point.mean_m - core::transform(best.T_map_branch, seen.point.mean_m);
    information += J.transpose() * W * J;
    gradient += J.transpose() * W * d;
    chi2 += d.dot(W * d);
  }
  EXPECT_LT((best.information - information).norm(), 1e-4 * information.norm());
  EXPECT_NEAR(best.chi2, chi2, 1e-3);
  EXPECT_LT((information.inverse() * gradient).norm(), 1e-4);  // the pose is the weighted optimum
}

TEST(Evidence, HasThePoseOfTheClosedFormWhereNoiseIsRound) {
  core::RandomStream random(2);
  const test::Points world = test::uniform_world(600, random);
  const MapIndex index = test::index_of(world, evidence_index);
  const test::Asked asked = test::ask_somewhere(world, {20, 0.3}, random);
  const Place best = ask(index, asked.question).places.front();
  // Complex numbers: map ≈ translation + turn · branch.
  using Complex = std::complex<double>;
  const auto complex = [](const Eigen::Vector2d& p) { return Complex(p.x(), p.y()); };
  Complex mean_map = 0.0;
  Complex mean_branch = 0.0;
  const double n = static_cast<double>(best.pairs.size());
  const auto branch_of = [&](const Pair& pair) {
    return complex(asked.question.landmarks[static_cast<std::size_t>(pair.branch)].point.mean_m);
  };
  for (const Pair& pair : best.pairs) {
    mean_map += complex(world[static_cast<std::size_t>(pair.map)]) / n;
    mean_branch += branch_of(pair) / n;
  }
  Complex turn = 0.0;
  for (const Pair& pair : best.pairs)
    turn += (complex(world[static_cast<std::size_t>(pair.map)]) - mean_map) * std::conj(branch_of(pair) - mean_branch);
  turn /= std::abs(turn);
  const Complex translation = mean_map - turn * mean_branch;
  EXPECT_NEAR(best.T_map_branch.heading_rad, std::arg(turn), 1e-6);
  EXPECT_NEAR(best.T_map_branch.x_m, translation.real(), 1e-3);  // 1e-6 rad at a lever arm of 500 m
  EXPECT_NEAR(best.T_map_branch.y_m, translation.imag(), 1e-3);
}

TEST(Evidence, GrowsByWhatKindsSay) {
  SmallCase world;
  const double without = ask(world.index(), world.question).places.front().evidence;
  for (Landmark& landmark : world.map) landmark.kind = landmark.id % 2;
  for (Landmark& landmark : world.question.landmarks) landmark.kind = landmark.id % 2;
  const double with = ask(world.index(), world.question).places.front().evidence;
  // Shares with one seen beforehand of an unknown kind: four even and three odd of seven; pairs 0, 2, 4 and 1, 3.
  const double even = std::log(0.95 * 10.0 / 5.0 + 0.05);
  const double odd = std::log(0.95 * 10.0 / 4.0 + 0.05);
  EXPECT_NEAR(with - without, 3.0 * even + 2.0 * odd, 1e-9);
}

TEST(Evidence, GrowsWithSizesThatAgreeAndFallsABoundedWayWithOthers) {
  SmallCase world;
  const double without = ask(world.index(), world.question).places.front().evidence;
  for (Landmark& landmark : world.map) landmark.size = Size{0.1 + 0.1 * landmark.id, 0.01};
  for (Landmark& landmark : world.question.landmarks) landmark.size = Size{0.1 + 0.1 * landmark.id, 0.01};
  const double agreeing = ask(world.index(), world.question).places.front().evidence;
  for (Landmark& landmark : world.question.landmarks) landmark.size->mean_m += 5.0;
  const double contradicting = ask(world.index(), world.question).places.front().evidence;
  // Each of five: ln of the ratio of standard deviations (√0.04 of the population to √2 hundredths) and its exponent.
  EXPECT_NEAR(agreeing - without, 5.0 * std::log(0.2 / 0.01414), 5.0);
  EXPECT_GT(agreeing - without, 5.0);
  EXPECT_NEAR(contradicting - without, 5.0 * std::log(0.05), 1e-6);
}

TEST(Evidence, WeighsAPriorWithAHeavyTail) {
  SmallCase world;
  const MapIndex index = world.index();
  const Place without = ask(index, world.question).places.front();
  const double ln_ground = std::log(2.0 * core::pi * index.looked_at_m2());
  Prior prior;
  prior.T_map_branch.mean = without.T_map_branch;
  prior.T_map_branch.covariance = Eigen::Vector3d(4.0, 4.0, 0.01).asDiagonal();
  prior.epsilon = 0.05;
  world.question.prior = prior;
  const double ln_peak = -1.5 * std::log(2.0 * core::pi) - 0.5 * std::log(4.0 * 4.0 * 0.01);
  EXPECT_NEAR(ask(index, world.question).places.front().evidence - without.evidence,
              std::log(0.95 * std::exp(ln_peak) + 0.05 * std::exp(-ln_ground)) + ln_ground, 1e-9);
  world.question.prior->T_map_branch.mean.x_m += 1000.0;  // a wrong prior costs ln(1/ε) and no more
  const Place outweighed = ask(index, world.question).places.front();
  EXPECT_NEAR(outweighed.evidence - without.evidence, std::log(0.05), 1e-9);
  EXPECT_EQ(outweighed.pairs.size(), without.pairs.size());
}

}  // namespace
}  // namespace helixnav::relocalize
