// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::mrpt_adapter {

/// Which navigator is wanted is only known at the first measurements: until then both are fed, and the other one goes then.
class EitherNavigator {
 public:
  EitherNavigator(const core::PoseGaussian& start, const supervisor::NavigatorOptions& options)
      : named_(std::in_place, start, options), unnamed_(std::in_place, start, options) {}

  void move(const core::Odometry& odometry) {
    if (named_) named_->move(odometry);
    if (unnamed_) unnamed_->move(odometry);
  }

  void fix(const core::AbsoluteFix& fix) {
    if (named_) named_->fix(fix);
    if (unnamed_) unnamed_->fix(fix);
  }

  /// A scan without measurements: both are still wanted.
  core::StepReport observe_nothing(const core::Scan& scan) {
    if (!named_) return unnamed_->observe(scan);
    core::StepReport report = named_->observe(scan, {});
    return unnamed_ ? unnamed_->observe(scan) : report;
  }

  core::StepReport observe(const core::Scan& scan) {
    named_.reset();
    return unnamed_->observe(scan);
  }

  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) {
    unnamed_.reset();
    return named_->observe(scan, identities);
  }

  core::PoseGaussian pose() const { return filter().pose(); }
  std::vector<core::MapLandmark> map() const { return unnamed_ ? unnamed_->map() : named_->map(); }
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const {
    return unnamed_ ? unnamed_->joint(ids) : named_->joint(ids);
  }
  const cekf::CompressedEkf& filter() const { return unnamed_ ? unnamed_->filter() : named_->filter(); }

 private:
  std::optional<supervisor::NamedNavigator> named_;
  std::optional<supervisor::Navigator> unnamed_;
};

}  // namespace helixnav::mrpt_adapter
