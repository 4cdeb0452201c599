// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/fastslam/fast_slam.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "impl.hpp"

namespace helixnav::fastslam {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw core::PreconditionError(std::string("FastSLAM: ") + what);
}

void check(const Options& o) {
  const auto probability = [](double p) { return p > 0.0 && p < 1.0; };
  require(o.particles >= 1 && o.particles < (1U << 24U), "particles must be 1 … 16 million");
  require(o.match_gate > 0.0 && o.new_gate >= o.match_gate, "gates must be 0 < match_gate ≤ new_gate");
  require(probability(o.detection_probability), "detection_probability must be between 0 and 1");
  require(o.new_density > 0.0 && o.clutter_density > 0.0, "densities must be positive");
  require(o.resample_below >= 0.0 && o.resample_below <= 1.0, "resample_below must be 0 … 1");
  require(o.hypotheses.resample_every_scans >= 1 && o.hypotheses.most_children >= 1,
          "resample_every_scans and most_children must be at least 1");
  require(o.added_sigma_m >= 0.0 && o.added_sigma_rad >= 0.0, "added noise must not be negative");
  require(o.genealogy_m > 0.0 && o.threads >= 1 && o.threads <= 256, "genealogy_m must be positive, threads 1 … 256");
  const ExistenceOptions& e = o.existence;
  require(probability(e.detection_probability) && probability(e.false_hit_probability) &&
              e.false_hit_probability < e.detection_probability,
          "existence needs 0 < false_hit_probability < detection_probability < 1");
  require(e.look_distance_m >= 0.0 && e.mature_looks >= 1, "looks need a distance ≥ 0 and a number ≥ 1");
}

void check_seen(const core::Scan& scan) {
  for (const core::Observation& observation : scan.observations) {
    core::check_observation(observation);
    require(core::dimension(observation.kind) == 2, "a bearing or a range alone cannot begin a landmark");
  }
  require(scan.T_robot_sensor.vector().allFinite(), "the sensor's pose must be finite");
}

}  // namespace

FastSlam::FastSlam(const core::PoseGaussian& start, const Options& options, std::uint64_t seed)
    : FastSlam(std::vector<core::PoseGaussian>{start}, options, seed) {}

FastSlam::FastSlam(const std::vector<core::PoseGaussian>& starts, const Options& options, std::uint64_t seed) {
  check(options);
  require(!starts.empty(), "there must be a robot");
  for (const core::PoseGaussian& start : starts) core::check_start(start);
  impl_ = std::make_unique<Impl>(starts, options, seed);
}

FastSlam::~FastSlam() = default;
FastSlam::FastSlam(FastSlam&&) noexcept = default;
FastSlam& FastSlam::operator=(FastSlam&&) noexcept = default;

void FastSlam::begin_with(const std::vector<core::PointGaussian>& landmarks) {
  require(impl_->step == 0 && impl_->lineages.size() == 0, "a map can be given only before anything else");
  for (const core::PointGaussian& landmark : landmarks) {
    require(landmark.mean_m.allFinite() && core::is_symmetric_positive_definite(landmark.covariance_m2),
            "a landmark must be finite with a positive definite covariance");
  }
  impl_->begin_with(landmarks);
}

void FastSlam::predict(const core::Odometry& odometry, std::size_t robot) {
  require(robot < impl_->robots.size(), "there is no such robot");
  require(odometry.T_before_after.vector().allFinite() && odometry.covariance.allFinite() &&
              core::is_symmetric_positive_semidefinite(odometry.covariance),
          "an increment must be finite with a symmetric positive semidefinite covariance");
  std::optional<core::Odometry>& motion = impl_->robots[robot].motion;
  motion = motion.has_value() ? core::chain(*motion, odometry) : odometry;
}

core::StepReport FastSlam::update(const core::Scan& scan, std::size_t robot) {
  require(robot < impl_->robots.size(), "there is no such robot");
  require(impl_->options.association != Association::known, "Association::known needs names");
  check_seen(scan);
  return impl_->update(scan, nullptr, robot);
}

core::StepReport FastSlam::update_known(const core::Scan& scan, const std::vector<KnownName>& names,
                                        std::size_t robot) {
  require(robot < impl_->robots.size(), "there is no such robot");
  require(impl_->options.association == Association::known, "names are for Association::known");
  require(names.size() == scan.observations.size(), "there must be one name an observation");
  std::vector<KnownName> sorted;
  std::copy_if(names.begin(), names.end(), std::back_inserter(sorted), [](KnownName n) { return n != no_name; });
  std::sort(sorted.begin(), sorted.end());
  require(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end(), "a scan must not name a landmark twice");
  check_seen(scan);
  return impl_->update(scan, &names, robot);
}

core::PoseGaussian FastSlam::pose(std::size_t robot) const {
  require(robot < impl_->robots.size(), "there is no such robot");
  const Impl::Robot& r = impl_->robots[robot];
  if (!r.motion.has_value()) return r.mean;
  const core::ComposeJacobians J = core::compose_jacobians(r.mean.mean, r.motion->T_before_after);
  return {core::compose(r.mean.mean, r.motion->T_before_after),
          J.J_first * r.mean.covariance * J.J_first.transpose() +
              J.J_second * r.motion->covariance * J.J_second.transpose()};
}

const std::vector<core::Pose2>& FastSlam::poses(std::size_t robot) const {
  require(robot < impl_->robots.size(), "there is no such robot");
  return impl_->robots[robot].poses;
}

std::vector<double> FastSlam::weights() const {
  std::vector<double> weights;
  for (const double lw : impl_->log_weight) weights.push_back(std::exp(lw));
  return weights;
}

std::vector<core::MapLandmark> FastSlam::map() const { return impl_->map_of(impl_->best); }

std::vector<core::MapLandmark> FastSlam::map_of(std::size_t particle) const {
  require(particle < impl_->maps.size(), "there is no such particle");
  return impl_->map_of(particle);
}

std::size_t FastSlam::best() const { return impl_->best; }
std::vector<core::MixedLandmark> FastSlam::mixture() const { return impl_->mixture(); }
const core::CloudReport& FastSlam::cloud() const { return impl_->cloud; }
const std::vector<std::uint32_t>& FastSlam::parents() const { return impl_->parents; }
MemoryReport FastSlam::memory() const { return impl_->memory(); }

KnownName FastSlam::name_of(core::LandmarkId id) const {
  const auto found = impl_->names_of_lineages.find(static_cast<LineageId>(id));
  return found == impl_->names_of_lineages.end() ? no_name : found->second;
}

}  // namespace helixnav::fastslam
