// SPDX-License-Identifier: BSD-3-Clause
#include "start_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <Eigen/Cholesky>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "helixnav/supervisor/pose_on_map.hpp"

namespace helixnav::apps {
namespace {

supervisor::Navigator looking_in(const core::JointMap& map, const core::Pose2& T_map_start,
                                 const supervisor::NavigatorOptions& options) {
  supervisor::Navigator navigator(core::PoseGaussian{T_map_start, Eigen::Matrix3d::Zero()}, options);
  navigator.look_for_place_in(map);
  return navigator;
}

template <class Kind>
bool holds(const core::StepReport& report, bool (*is_wanted)(const Kind&)) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [&](const core::Decision& decision) {
    const auto* one = std::get_if<Kind>(&decision);
    return one != nullptr && is_wanted(*one);
  });
}

bool was_carried(const core::StepReport& report) {
  return holds<core::CarriedDecision>(report, [](const core::CarriedDecision&) { return true; });
}

bool has_place(const core::StepReport& report) {
  return holds<core::PlacedDecision>(report, [](const core::PlacedDecision& placed) {
    return placed.verdict == core::PlacedDecision::Verdict::accepted && placed.part == 0;
  });
}

}  // namespace

StartCheck::StartCheck(const core::JointMap& map, const core::Pose2& T_map_start, double reach_m,
                       const supervisor::NavigatorOptions& options)
    : next_name_(map.next_name),
      reach_m_(reach_m),
      apart_m_(options.search.rivals.apart_m * reach_m / supervisor::reference_reach_m),
      apart_rad_(options.search.rivals.apart_rad),
      navigator_(looking_in(map, T_map_start, options)) {}

void StartCheck::take(const core::Event& event, const core::StepReport* report, const Believed& believed) {
  constexpr double most_reaches = 30.0;
  if (is_over_) return;
  // A vehicle that was carried has another place now, and fixes determine it without landmarks.
  const bool is_pointless = std::holds_alternative<core::Lost>(event) ||
                            std::holds_alternative<core::AbsoluteFix>(event) ||
                            (report != nullptr && was_carried(*report));
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
    driven_m_ += odometry->T_before_after.position_m().norm();
  }
  is_over_ = is_pointless || driven_m_ > most_reaches * reach_m_;
  if (is_over_) return;
  try {
    if (std::optional<core::StepReport> own = navigator_.take(event)) observe(std::move(*own), believed);
  } catch (const core::NumericalError&) {
    is_over_ = true;  // the session goes on as it is
  }
}

void StartCheck::observe(core::StepReport own, const Believed& believed) {
  is_over_ = was_carried(own) || has_place(own);
  for (const core::Decision& decision : own.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr) is_ambiguous_ = placed->verdict == core::PlacedDecision::Verdict::ambiguous;
  }
  if (has_place(own) && is_elsewhere(believed())) {
    report_ = std::move(own);
    return;
  }
  for (core::RevisedScan& again : own.revised) {
    revised_.at(static_cast<std::size_t>(again.step)).associations = std::move(again.associations);
  }
  revised_.push_back({own.step, std::move(own.associations)});
  path_.push_back({own.t_ns, own.pose.mean});
}

/// Farther than two hypotheses of one place are apart, and than the two may err.
bool StartCheck::is_elsewhere(const core::PoseGaussian& believed) const {
  static const double limit = core::chi2_quantile(0.9999, 3);
  const core::PoseGaussian found = supervisor::pose_on_map(navigator_.filter(), next_name_);
  Eigen::Vector3d d = found.mean.vector() - believed.mean.vector();
  d.z() = core::wrap_to_pi(d.z());
  if (d.head<2>().norm() < apart_m_ && std::abs(d.z()) < apart_rad_) return false;
  return d.dot((found.covariance + believed.covariance).ldlt().solve(d)) > limit;
}

std::optional<StartCheck::RightStart> StartCheck::right_start() {
  if (!report_) return std::nullopt;
  core::StepReport report = std::move(*report_);
  report_.reset();
  core::CarriedDecision wrong;
  wrong.part = wrong.apart = 1;
  wrong.cause = core::CarriedDecision::Cause::wrong_start;
  wrong.scans = static_cast<int>(revised_.size());
  report.decisions.insert(report.decisions.begin(), wrong);
  report.revised.insert(report.revised.begin(), std::make_move_iterator(revised_.begin()),
                        std::make_move_iterator(revised_.end()));
  if (report.solved.empty()) report.solved = std::move(path_);
  return RightStart{std::move(navigator_), std::move(report)};
}

}  // namespace helixnav::apps
