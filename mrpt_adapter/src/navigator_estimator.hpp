// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "estimator.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::mrpt_adapter {

/// Which navigator is wanted is only known at the first measurements: until then both are fed, and the other one goes then.
class NavigatorEstimator : public Estimator {
 public:
  using Names = std::map<std::int64_t, core::LandmarkId>;

  NavigatorEstimator(const core::PoseGaussian& start, const supervisor::NavigatorOptions& options);
  /// Goes on in an earlier map from the pose in it. With names, its landmarks are known by them; without, by place alone.
  NavigatorEstimator(const core::JointMap& earlier, const Names& names, const supervisor::NavigatorOptions& options);
  /// Begins anywhere; the place on the earlier map is sought by landmarks.
  static std::unique_ptr<NavigatorEstimator> looking_for_place_in(const core::JointMap& earlier,
                                                                  const supervisor::NavigatorOptions& options);

  void move(const core::Odometry& odometry) override;
  void fix(const core::AbsoluteFix& fix) override;
  core::StepReport observe_nothing(const core::Scan& scan) override;
  core::StepReport observe(const core::Scan& scan) override;
  core::StepReport observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) override;

  core::PoseGaussian pose() const override;
  std::vector<core::MapLandmark> map() const override;
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const override;
  std::vector<WeightedPose> particles() const override { return {}; }
  core::JointMap joint_map() const override;
  bool place_is_known() const override { return place_is_known_; }
  std::optional<core::JointMap> sought_in() const override;
  void lose() override;

 private:
  explicit NavigatorEstimator(supervisor::Navigator unnamed) : unnamed_(std::move(unnamed)), place_is_known_(false) {}
  core::StepReport noted(core::StepReport report);

  std::optional<supervisor::NamedNavigator> named_;
  std::optional<supervisor::Navigator> unnamed_;
  bool place_is_known_ = true;
};

}  // namespace helixnav::mrpt_adapter
