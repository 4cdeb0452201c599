// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/mrpt_adapter/map_builder.hpp"

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDF.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "map_builder_impl.hpp"
#include "navigator_estimator.hpp"
#include "navigator_options.hpp"
#include "particle_estimator.hpp"
#include "pose_pdf.hpp"

namespace helixnav::mrpt_adapter {
namespace {

void check_that_maps_are_updated(const mrpt::slam::CMetricMapBuilder::TOptions& options) {
  if (options.enableMapUpdating) return;
  throw core::PreconditionError("map updating is switched off, and this filter does not localise without mapping");
}

std::unique_ptr<Estimator> estimator_at(const core::PoseGaussian& start, const MapBuilderOptions& options) {
  if (options.filter != "fastslam") return std::make_unique<NavigatorEstimator>(start, navigator_options(options));
  if (options.gps_use) throw core::InputError("gps_use = true: FastSLAM (filter = fastslam) takes no fixes");
  return std::make_unique<ParticleEstimator>(start, fastslam_options(options), options.fastslam_seed);
}

}  // namespace

MapBuilder::Impl::Impl(const MapBuilderOptions& its_options, const mrpt::system::COutputLogger& log,
                       std::mutex& its_lock)
    : options(its_options), lock(its_lock), profiler(its_options.enable_profiler, "helixnav::MapBuilder"), log_(log) {
  start_at({});
}

void MapBuilder::Impl::start_at(const core::PoseGaussian& start) { restart(estimator_at(start, options)); }

void MapBuilder::Impl::restart(std::unique_ptr<Estimator> estimator) {
  navigator = std::move(estimator);
  simple_map.clear();
  path.clear();
  steps.clear();
  last.reset();
  last_measurements.clear();
  motion_ = {};
  if (options.gps_latitude_deg != 0.0 || options.gps_longitude_deg != 0.0) {
    motion_.reference = GpsReference{options.gps_latitude_deg, options.gps_longitude_deg, options.gps_altitude};
  }
  motion_is_known_ = false;
  part_begin_ = 0;
  association_ = Association::open;
  name_of_.clear();
  seen_ns_.clear();
  warned_.clear();
  metric_map_is_current_ = false;
}

MapBuilder::MapBuilder(const MapBuilderOptions& builder_options) {
  setLoggerName("helixnav::MapBuilder");
  impl_ = std::make_unique<Impl>(builder_options, *this, critZoneChangingMap);
}

MapBuilder::~MapBuilder() = default;

const MapBuilderOptions& MapBuilder::getOptions() const { return impl_->options; }

void MapBuilder::initialize(const mrpt::maps::CSimpleMap& initialMap, const mrpt::poses::CPosePDF* x0) {
  if (!initialMap.empty()) {
    throw core::InputError(
        "initialize: a past map of " + std::to_string(initialMap.size()) +
        " frames cannot be taken over, a CSimpleMap does not say how their errors go together; a run "
        "folder can");
  }
  const core::PoseGaussian start = x0 != nullptr ? gaussian_of(*x0) : core::PoseGaussian{};
  const Impl::Lock lock(impl_->lock);
  impl_->start_at(start);
}

void MapBuilder::processActionObservation(mrpt::obs::CActionCollection& action,
                                          mrpt::obs::CSensoryFrame& observations) {
  check_that_maps_are_updated(options);
  const Impl::Lock lock(impl_->lock);
  impl_->feed(odometry_of(action), observations, /*stream=*/false);
}

void MapBuilder::processObservation(const mrpt::obs::CObservation::Ptr& observation) {
  if (!observation) throw core::PreconditionError("processObservation: no observation");
  check_that_maps_are_updated(options);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  const Impl::Lock lock(impl_->lock);
  impl_->feed(std::nullopt, frame, /*stream=*/true);
}

mrpt::poses::CPose3DPDF::Ptr MapBuilder::getCurrentPoseEstimation() const {
  const Impl::Lock lock(impl_->lock);
  if (impl_->last && !impl_->last->cloud.empty()) return particle_pdf(impl_->last->cloud);
  const std::vector<WeightedPose> particles = impl_->navigator->particles();
  if (!particles.empty()) return particle_pdf(particles);
  return gaussian_pdf(impl_->navigator->pose());
}

void MapBuilder::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const {
  const Impl::Lock lock(impl_->lock);
  out_map = impl_->simple_map;
}

unsigned int MapBuilder::getCurrentlyBuiltMapSize() {
  const Impl::Lock lock(impl_->lock);
  return static_cast<unsigned int>(impl_->simple_map.size());
}

MetricMapResult MapBuilder::getCurrentlyBuiltMetricMap() const {
  const Impl::Lock lock(impl_->lock);
  return metric_map_result(impl_->metric_map());
}

const mrpt::system::CTimeLogger& MapBuilder::getProfiler() const { return impl_->profiler; }

const std::vector<Step>& RunAccess::last_steps(const MapBuilder& builder) { return builder.impl_->steps; }

std::vector<core::MapLandmark> RunAccess::map(const MapBuilder& builder) { return builder.impl_->navigator->map(); }

std::optional<core::JointMap> RunAccess::joint_map(const MapBuilder& builder) {
  if (builder.getOptions().filter == "fastslam") return std::nullopt;
  return builder.impl_->joint_map();
}

core::PoseGaussian RunAccess::pose(const MapBuilder& builder) { return builder.impl_->navigator->pose(); }

}  // namespace helixnav::mrpt_adapter
