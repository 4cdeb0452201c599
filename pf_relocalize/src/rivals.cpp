// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/rivals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "helixnav/core/random.hpp"
#include "helixnav/pf_relocalize/helix_proposal.hpp"
#include "refine_pose.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr std::array<double, 9> softening{1.0, 1.0, 1.0, 0.5, 0.5, 0.24, 0.24, 0.0, 0.0};  // of soften_m
constexpr double detection_probability = 0.77;

/// Branch landmarks as points of the vehicle, less certain across the line of sight the further they are.
std::vector<RobotPoint> points_of(const std::vector<BranchLandmark>& branch, const RivalOptions& options) {
  std::vector<RobotPoint> points;
  for (const BranchLandmark& landmark : branch) {
    const Eigen::Vector2d& b = landmark.point_robot_m;
    const Eigen::Vector2d across = options.lever_rad * Eigen::Vector2d(-b.y(), b.x());
    Eigen::Matrix2d covariance = across * across.transpose();
    covariance.diagonal().array() += options.branch_sigma_m * options.branch_sigma_m;
    points.push_back({b, covariance});
  }
  return points;
}

/// Poses of a cloud by falling weight, the first `count` that are at least `distinct_m` (or 8°) from those before.
std::vector<core::Pose2> best_apart(const Particles& cloud, std::size_t count, double distinct_m, double distinct_rad) {
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cloud.log_weight[a] != cloud.log_weight[b] ? cloud.log_weight[a] > cloud.log_weight[b] : a < b;
  });
  std::vector<core::Pose2> best;
  for (const std::size_t i : order) {
    if (best.size() == count || !std::isfinite(cloud.log_weight[i])) break;
    const bool apart = std::all_of(best.begin(), best.end(), [&](const core::Pose2& pose) {
      return std::hypot(pose.x_m - cloud.x_m[i], pose.y_m - cloud.y_m[i]) >= distinct_m ||
             std::abs(core::wrap_to_pi(pose.heading_rad - cloud.heading_rad[i])) >= distinct_rad;
    });
    if (apart) best.push_back(cloud.pose(i));
  }
  return best;
}

/// The region that rivals may come from: inside the prior, away from the winner.
class RivalRegion {
 public:
  RivalRegion(const ReferenceMap& map, const core::Pose2& winner, const RivalOptions& options)
      : map_(map), winner_(winner), options_(options) {
    Eigen::Matrix3d covariance = map.prior.covariance;
    covariance.diagonal().array() += 1e-9;
    information_ = covariance.inverse();
  }

  bool contains(const core::Pose2& pose) const {
    const core::Pose2& mean = map_.prior.mean;
    const Eigen::Vector3d d(pose.x_m - mean.x_m, pose.y_m - mean.y_m,
                            core::wrap_to_pi(pose.heading_rad - mean.heading_rad));
    if (d.dot(information_ * d) > options_.prior_chi2) return false;
    return (pose.position_m() - winner_.position_m()).norm() > options_.apart_m ||
           std::abs(core::wrap_to_pi(pose.heading_rad - winner_.heading_rad)) > options_.apart_rad;
  }

 private:
  const ReferenceMap& map_;
  const core::Pose2& winner_;
  const RivalOptions& options_;
  Eigen::Matrix3d information_;
};

core::Pose2 refined(const LandmarkTable& table, const std::vector<RobotPoint>& points, double density_ratio_m2,
                    double soften_m, core::Pose2 pose) {
  for (const double share : softening) pose = refine_pose(table, points, density_ratio_m2, share * soften_m, pose);
  return pose;
}

/// Weighs the poses by the likelihood of the points; −∞ outside the region.
void weigh(const ScanLikelihood& likelihood, const RivalRegion& region, Particles& cloud) {
  likelihood.evaluate(cloud, 0, cloud.size(), cloud.log_weight.data());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!region.contains(cloud.pose(i))) cloud.log_weight[i] = -HUGE_VAL;
  }
}

}  // namespace

RivalPoses find_rivals(const ReferenceMap& reference, const std::vector<BranchLandmark>& branch,
                       const core::Pose2& winner, const RivalOptions& options, std::uint64_t seed) {
  if (branch.size() < 3) return {winner, {}};
  ReferenceMap map = reference;  // common errors of the map do not matter here: all points are compared at once
  map.latent.resize(2 * static_cast<Eigen::Index>(map.landmarks.size()), 0);
  map.prior_by_latent.resize(3, 0);
  constexpr double chi2_of_helices = 16.0;  // the proposal covers four σ of what it takes for the prior
  map.prior.covariance *= std::max(1.0, options.prior_chi2 / chi2_of_helices);
  const LandmarkTable table(map);
  const std::vector<RobotPoint> points = points_of(branch, options);
  const double density_ratio_m2 = detection_probability / options.extraneous_per_m2;
  ScanLikelihood likelihood(map, {detection_probability, 1.0});
  likelihood.set_points(points, options.extraneous_per_m2);

  RivalPoses poses;
  poses.winner = refined(table, points, density_ratio_m2, options.soften_m, winner);
  const RivalRegion region(reference, poses.winner, options);

  Particles cloud;
  cloud.resize(options.helices);
  HelixProposal proposal(map, likelihood, {});
  core::RandomStream random(seed, "rivals");
  proposal.allot(cloud.size(), random.uniform());
  proposal.sample(cloud, 0, cloud.size(), random);
  order_by_place(cloud);
  weigh(likelihood, region, cloud);

  const std::vector<core::Pose2> starts =
      best_apart(cloud, options.starts, 0.5 * options.distinct_m, 0.25 * options.apart_rad);
  cloud.resize(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    cloud.set_pose(i, refined(table, points, density_ratio_m2, options.soften_m, starts[i]));
  }
  weigh(likelihood, region, cloud);
  poses.rivals = best_apart(cloud, options.most_rivals, options.distinct_m, options.apart_rad);
  return poses;
}

}  // namespace helixnav::pf_relocalize
