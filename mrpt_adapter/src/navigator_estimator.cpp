// SPDX-License-Identifier: BSD-3-Clause
#include "navigator_estimator.hpp"

#include <optional>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::mrpt_adapter {

NavigatorEstimator::NavigatorEstimator(const core::PoseGaussian& start, const supervisor::NavigatorOptions& options)
    : named_(std::in_place, start, options), unnamed_(std::in_place, start, options) {}

NavigatorEstimator::NavigatorEstimator(const core::JointMap& earlier, const Names& names,
                                       const supervisor::NavigatorOptions& options) {
  if (names.empty()) {
    unnamed_.emplace(supervisor::Navigator::go_on_in(earlier, options));
  } else {
    named_.emplace(earlier, names, options);
  }
}

std::unique_ptr<NavigatorEstimator> NavigatorEstimator::looking_for_place_in(
    const core::JointMap& earlier, const supervisor::NavigatorOptions& options) {
  supervisor::Navigator navigator(core::PoseGaussian{}, options);
  navigator.look_for_place_in(earlier);
  return std::unique_ptr<NavigatorEstimator>(new NavigatorEstimator(std::move(navigator)));
}

void NavigatorEstimator::move(const core::Odometry& odometry) {
  if (named_) named_->move(odometry);
  if (unnamed_) unnamed_->move(odometry);
}

void NavigatorEstimator::fix(const core::AbsoluteFix& fix) {
  if (named_) named_->fix(fix);
  if (unnamed_) unnamed_->fix(fix);
}

core::StepReport NavigatorEstimator::observe_nothing(const core::Scan& scan) {
  if (!named_) return noted(unnamed_->observe(scan));
  core::StepReport report = named_->observe(scan, {});
  return unnamed_ ? noted(unnamed_->observe(scan)) : report;
}

core::StepReport NavigatorEstimator::observe(const core::Scan& scan) {
  named_.reset();
  return noted(unnamed_->observe(scan));
}

/// The maps apart are copied to be looked at: only where something changed.
core::StepReport NavigatorEstimator::noted(core::StepReport report) {
  for (const core::Decision& decision : report.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    const bool found = placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
    if (!found && !std::holds_alternative<core::CarriedDecision>(decision)) continue;
    place_is_known_ = unnamed_->maps_apart().empty();
  }
  return report;
}

core::StepReport NavigatorEstimator::observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) {
  unnamed_.reset();
  return named_->observe(scan, identities);
}

core::PoseGaussian NavigatorEstimator::pose() const { return unnamed_ ? unnamed_->pose() : named_->pose(); }

std::vector<core::MapLandmark> NavigatorEstimator::map() const { return unnamed_ ? unnamed_->map() : named_->map(); }

core::JointGaussian NavigatorEstimator::joint(const std::vector<core::LandmarkId>& ids) const {
  return unnamed_ ? unnamed_->joint(ids) : named_->joint(ids);
}

core::JointMap NavigatorEstimator::joint_map() const {
  const std::vector<core::MapLandmark> landmarks = map();
  if (!unnamed_) return supervisor::joint_map(*named_, landmarks);
  std::optional<core::JointMap> map = supervisor::map_to_go_on_in(*unnamed_, landmarks, runs::most_joint_landmarks);
  return map ? std::move(*map) : supervisor::joint_map(*unnamed_, landmarks);
}

std::optional<core::JointMap> NavigatorEstimator::sought_in() const {
  if (place_is_known_) return std::nullopt;
  return unnamed_->maps_apart().begin()->second;
}

void NavigatorEstimator::lose() {
  if (!unnamed_) throw core::PreconditionError("landmarks known by name are not searched for: give the pose");
  named_.reset();
  unnamed_->lose({});
  place_is_known_ = unnamed_->maps_apart().empty();
}

}  // namespace helixnav::mrpt_adapter
