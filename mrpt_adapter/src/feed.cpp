// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <sstream>
#include <utility>

#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/reports/decision_sentence.hpp"
#include "map_builder_impl.hpp"
#include "pose_pdf.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

core::Odometry unknown_motion(const MapBuilderOptions& options) {
  core::Odometry odometry;
  const double xy_m2 = options.stdXY_no_odo * options.stdXY_no_odo;
  odometry.covariance =
      Eigen::Vector3d(xy_m2, xy_m2, options.stdPhi_no_odo_rad * options.stdPhi_no_odo_rad).asDiagonal();
  return odometry;
}

}  // namespace

void MapBuilder::Impl::feed(const std::optional<core::Odometry>& motion, const mrpt::obs::CSensoryFrame& frame,
                            bool stream) {
  const mrpt::system::CTimeLoggerEntry complete(profiler, "complete_step");
  steps.clear();
  const std::optional<core::Odometry> stated = options.force_ignore_odometry ? std::nullopt : motion;
  profiler.enter("convert");
  FrameInput input;
  try {
    input = convert_frame(frame, stated.has_value(), motion_, options);
  } catch (...) {
    profiler.leave("convert");
    throw;
  }
  profiler.leave("convert");
  motion_ = input.motion;
  motion_is_known_ = !options.force_ignore_odometry && (motion_is_known_ || stated || motion_.last_reading);
  for (const std::string& warning : input.warnings) warn(warning);
  // Without any word on motion, the vehicle moved in some way from frame to frame: but not before the first one.
  if (stated) {
    navigator->move(*stated);
  } else if (!stream && last && (!motion_.last_reading || options.force_ignore_odometry)) {
    navigator->move(unknown_motion(options));
  }
  for (const Input& one : input.inputs) {
    if (const auto* odometry = std::get_if<core::Odometry>(&one)) navigator->move(*odometry);
    if (const auto* scan = std::get_if<NamedScan>(&one)) see(*scan, stream);
    if (const auto* fix = std::get_if<core::AbsoluteFix>(&one)) navigator->fix(*fix);
  }
  if (!steps.empty() && options.create_simplemap) keep(frame);
}

void MapBuilder::Impl::see(NamedScan scan, bool stream) {
  const bool same_instant = last && scan.has_time && scan.scan.t_ns == last->t_ns;
  if (stream && last && !motion_is_known_ && !same_instant) navigator->move(unknown_motion(options));
  if (last && !scan.has_time) scan.scan.t_ns = last->t_ns;
  if (!scan.has_time) warn("an observation has no time stamp, the last one's is taken for it");
  if (last && scan.scan.t_ns < last->t_ns) warn("an observation is older than the last one that was used");
  reach_m_ = scan.scan.field_of_view.reach().value_or(reach_m_);
  const Clock::time_point begin = Clock::now();
  Step step;
  {
    const mrpt::system::CTimeLoggerEntry navigate(profiler, "navigate");
    step.report = observe(scan);
  }
  step.microseconds = microseconds_since(begin);
  metric_map_is_current_ = false;
  remember(scan, step.report);
  tell(step.report);
  place_path(step.report);
  path.push_back(step.report.pose.mean);
  last = step.report;
  last_measurements = scan.measurements;
  steps.push_back(std::move(step));
}

core::StepReport MapBuilder::Impl::observe(const NamedScan& scan) {
  const bool named = std::any_of(scan.identities.begin(), scan.identities.end(), [](std::int64_t i) { return i >= 0; });
  if (association_ == Association::open && !scan.identities.empty()) {
    association_ = named && options.use_landmark_ids ? Association::by_name : Association::unknown;
  }
  if (association_ == Association::by_name) {
    if (std::any_of(scan.identities.begin(), scan.identities.end(), [](std::int64_t i) { return i < 0; })) {
      warn("landmarks are told apart by landmarkID, and measurements without one are passed over");
    }
    return navigator->observe(scan.scan, scan.identities);
  }
  if (association_ == Association::open) return navigator->observe_nothing(scan.scan);
  if (named && options.use_landmark_ids) {
    warn(
        "association is unknown, as the first measurements had no landmarkID or an earlier map is gone on in: later "
        "IDs "
        "are passed over");
  }
  return navigator->observe(scan.scan);
}

void MapBuilder::Impl::remember(const NamedScan& scan, const core::StepReport& report) {
  for (const core::AssociationReport& association : report.associations) {
    using core::Outcome;
    if (association.outcome != Outcome::matched && association.outcome != Outcome::augmented) continue;
    seen_ns_[association.landmark] = scan.scan.t_ns;
    if (association_ != Association::by_name) continue;
    name_of_[association.landmark] = scan.identities[static_cast<std::size_t>(association.observation)];
  }
}

void MapBuilder::Impl::tell(const core::StepReport& report) const {
  for (const core::Decision& decision : report.decisions) {
    log_.logStr(mrpt::system::LVL_INFO, reports::sentence_of(decision));
  }
  if (!log_.isLoggingLevelVisible(mrpt::system::LVL_DEBUG)) return;
  std::ostringstream text;
  text << "step " << report.step << ": " << report.associations.size() << " measurements, " << report.joint_dof / 2
       << " matched with joint NIS " << report.joint_nis << ", " << report.mapped_landmarks << " landmarks, "
       << report.active_landmarks << " active";
  log_.logStr(mrpt::system::LVL_DEBUG, text.str());
}

void MapBuilder::Impl::warn(const std::string& text) {
  // The same fault in every frame is worth one line, and the details are there for who asks.
  std::string kind = text;
  kind.erase(std::remove_if(kind.begin(), kind.end(), [](char c) { return c >= '0' && c <= '9'; }), kind.end());
  log_.logStr(warned_.insert(kind).second ? mrpt::system::LVL_WARN : mrpt::system::LVL_DEBUG, text);
}

void MapBuilder::Impl::keep(const mrpt::obs::CSensoryFrame& frame) {
  simple_map.insert(gaussian_pdf(last->pose), mrpt::obs::CSensoryFrame::Create(frame));
}

}  // namespace helixnav::mrpt_adapter
