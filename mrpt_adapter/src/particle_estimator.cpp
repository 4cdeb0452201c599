// SPDX-License-Identifier: BSD-3-Clause
#include "particle_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/fastslam/observe.hpp"

namespace helixnav::mrpt_adapter {
namespace {

fastslam::Options by_name(fastslam::Options options) {
  options.association = fastslam::Association::known;
  options.existence.remove = false;  // what has a name is there
  return options;
}

}  // namespace

ParticleEstimator::ParticleEstimator(const core::PoseGaussian& start, const fastslam::Options& options,
                                     std::uint64_t seed)
    : pose_(start),
      named_(std::in_place, start, by_name(options), seed),
      unnamed_(std::in_place, start, options, seed) {}

void ParticleEstimator::move(const core::Odometry& odometry) {
  if (named_) named_->predict(odometry);
  if (unnamed_) unnamed_->predict(odometry);
}

core::StepReport ParticleEstimator::observe_nothing(const core::Scan& scan) {
  if (!named_) return noted(unnamed_->update(scan));
  core::StepReport report = named_->update_known(scan, {});
  return noted(unnamed_ ? unnamed_->update(scan) : report);
}

core::StepReport ParticleEstimator::observe(const core::Scan& scan) {
  named_.reset();
  return noted(fastslam::observe(*unnamed_, scan));
}

core::StepReport ParticleEstimator::observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) {
  unnamed_.reset();
  return noted(fastslam::observe_known(*named_, scan, identities));
}

core::StepReport ParticleEstimator::noted(core::StepReport report) {
  report.active_landmarks = report.mapped_landmarks;  // any may be matched
  pose_ = report.pose;
  return report;
}

core::PoseGaussian ParticleEstimator::pose() const { return pose_; }

core::JointGaussian ParticleEstimator::joint(const std::vector<core::LandmarkId>& ids) const {
  const std::vector<core::MapLandmark> landmarks = cloud().map();
  core::JointGaussian joint;
  joint.pose = pose_.mean;
  const auto rows = 3 + 2 * static_cast<Eigen::Index>(ids.size());
  joint.covariance = Eigen::MatrixXd::Zero(rows, rows);
  joint.covariance.topLeftCorner<3, 3>() = pose_.covariance;
  for (const core::LandmarkId id : ids) {
    const auto at =
        std::lower_bound(landmarks.begin(), landmarks.end(), id,
                         [](const core::MapLandmark& landmark, core::LandmarkId i) { return landmark.id < i; });
    if (at == landmarks.end() || at->id != id)
      throw core::PreconditionError("joint: no landmark " + std::to_string(id));
    const auto row = 3 + 2 * static_cast<Eigen::Index>(joint.ids.size());
    joint.ids.push_back(id);
    joint.points_m.push_back(at->point.mean_m);
    joint.covariance.block<2, 2>(row, row) = at->point.covariance_m2;
  }
  return joint;
}

std::vector<WeightedPose> ParticleEstimator::particles() const {
  const std::vector<core::Pose2>& poses = cloud().poses();
  const std::vector<double> weights = cloud().weights();
  std::vector<WeightedPose> particles;
  for (std::size_t i = 0; i < poses.size(); ++i) particles.push_back({poses[i], std::log(weights[i])});
  return particles;
}

core::JointMap ParticleEstimator::joint_map() const {
  throw core::PreconditionError("FastSLAM has no joint estimate of its map that another session could go on in");
}

void ParticleEstimator::lose() { throw core::PreconditionError("FastSLAM does not search for a place"); }

}  // namespace helixnav::mrpt_adapter
