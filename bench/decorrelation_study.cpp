// SPDX-License-Identifier: BSD-3-Clause
//
// What each decorrelation rule costs the search: the share of starts that pass the gate within 20 scans at the right and
// at a wrong pose. Truth is drawn from the joint estimate itself, so that every rule is given its true errors.
//   helixnav_decorrelation_study [runs = 60] [spacing factor = 1]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "helixnav/core/random.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "joint_map.hpp"

namespace {

using namespace helixnav;
using namespace helixnav::pf_relocalize;

constexpr int landmarks = 24;
constexpr double degree = core::pi / 180.0;

/// A map along a road, stretched, with the vehicle back in its middle, uncertain by 6 m and 4 degrees.
core::JointGaussian estimate(std::uint64_t seed, double stretch) {
  core::JointGaussian joint = test::drive_map(landmarks, seed, 0.3, 0.01 / stretch);
  for (Eigen::Vector2d& point : joint.points_m) point *= stretch;
  const Eigen::Vector2d ahead = joint.points_m[20] - joint.points_m[12];
  const Eigen::Vector2d middle = 0.5 * (joint.points_m[10] + joint.points_m[13]);
  joint.pose = core::Pose2(middle.x(), middle.y(), std::atan2(ahead.y(), ahead.x()));
  joint.covariance.topLeftCorner<3, 3>() += Eigen::Vector3d(36.0, 36.0, 16.0 * degree * degree).asDiagonal();
  return joint;
}

/// One draw from a joint estimate, which then drives on.
struct Truth {
  Truth(const core::JointGaussian& joint, std::uint64_t seed) : random(seed, "decorrelation study"), drawn(joint) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(joint.covariance);
    Eigen::VectorXd noise = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    for (double& value : noise) value *= random.normal();
    const Eigen::VectorXd error = eigen.eigenvectors() * noise;
    drawn.pose = core::Pose2(joint.pose.vector() + error.head<3>());
    for (int i = 0; i < landmarks; ++i) drawn.points_m[static_cast<std::size_t>(i)] += error.segment<2>(3 + 2 * i);
  }

  core::Odometry drive() {
    core::Odometry motion;
    motion.covariance = Eigen::Vector3d(0.01, 0.0025, 1.1e-4).asDiagonal();
    motion.T_before_after = core::Pose2(1.5, 0.0, 0.0);
    const Eigen::Vector3d increment = motion.T_before_after.vector() + random.normal3(motion.covariance);
    drawn.pose = core::compose(drawn.pose, core::Pose2(increment));
    return motion;
  }

  core::Scan scan() {
    core::Scan scan;
    scan.field_of_view = {0.0, 30.0, -core::pi / 2, core::pi / 2};
    const double sigma_m = 0.1, sigma_rad = 0.7 * degree;
    for (const Eigen::Vector2d& point : drawn.points_m) {
      const Eigen::Vector2d d = core::transform(core::inverse(drawn.pose), point);
      const double range = d.norm(), bearing = std::atan2(d.y(), d.x());
      if (range < 0.5 || range > 30.0 || std::abs(bearing) > core::pi / 2 || !random.bernoulli(0.9)) continue;
      scan.observations.push_back(core::make_range_bearing(
          range + random.normal(0.0, sigma_m), bearing + random.normal(0.0, sigma_rad), sigma_m, sigma_rad));
    }
    for (int clutter = random.poisson(1.0); clutter > 0; --clutter) {
      scan.observations.push_back(core::make_range_bearing(30.0 * std::sqrt(random.uniform(0.01, 1.0)),
                                                           random.uniform(-1.57, 1.57), sigma_m, sigma_rad));
    }
    return scan;
  }

  core::RandomStream random;
  core::JointGaussian drawn;
};

struct Counts {
  int right = 0, wrong = 0, open = 0;
  double scans_when_right = 0.0;
};

void search(const core::JointGaussian& joint, Decorrelation rule, std::uint64_t seed, Counts& counts) {
  ReferenceMapOptions map_options;
  map_options.decorrelation = rule;
  Truth truth(joint, seed);
  RelocalizerOptions options;
  options.sensor = {0.85, 1.5};
  Relocalizer search(build_reference_map(joint, map_options), truth.scan(), options, seed);
  while (search.state().scans < 21 && !meets_gate(search.state())) {
    const core::Odometry motion = truth.drive();
    search.step(motion, truth.scan());
  }
  if (!meets_gate(search.state())) {
    ++counts.open;
    return;
  }
  const core::Pose2 T_base_truth = core::between(base_frame(truth.drawn, search.map().bases), truth.drawn.pose);
  const core::Pose2 error = core::between(T_base_truth, search.state().modes.front().pose.mean);
  const bool right = error.position_m().norm() < 2.0 && std::abs(error.heading_rad) < 8.0 * degree;
  ++(right ? counts.right : counts.wrong);
  if (right) counts.scans_when_right += search.state().scans;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 60;
  const double stretch = argc > 2 ? std::atof(argv[2]) : 1.0;
  for (const Decorrelation rule :
       {Decorrelation::relative_marginals, Decorrelation::scalar_bound, Decorrelation::trace_bound,
        Decorrelation::whitened_bound, Decorrelation::constellations, Decorrelation::latent_modes}) {
    Counts counts;
    for (int run = 0; run < runs; ++run) {
      const auto seed = static_cast<std::uint64_t>(run);
      search(estimate(seed, stretch), rule, seed, counts);
    }
    std::printf("%-20s right %5.1f %%  wrong %4.1f %%  open %4.1f %%  scans %4.1f\n",
                std::string(name_of(rule)).c_str(), 100.0 * counts.right / runs, 100.0 * counts.wrong / runs,
                100.0 * counts.open / runs, counts.scans_when_right / std::max(1, counts.right));
    std::fflush(stdout);
  }
  return 0;
}
