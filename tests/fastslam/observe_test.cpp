// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/thin_scan.hpp"
#include "helixnav/fastslam/observe.hpp"

namespace helixnav::fastslam {
namespace {

core::Scan ring_of(std::size_t observations) {
  core::Scan scan;
  scan.field_of_view = {0.0, 30.0, -core::pi, core::pi};
  for (std::size_t i = 0; i < observations; ++i) {
    const double bearing = -3.1 + 6.2 * static_cast<double>(i) / static_cast<double>(observations);
    scan.observations.push_back(core::make_range_bearing(10.0, bearing, 0.01, 0.001));
  }
  return scan;
}

FastSlam cloud(Association association) {
  Options options;
  options.particles = 3;
  options.association = association;
  options.existence.remove = false;
  return FastSlam(core::PoseGaussian{}, options, 1);
}

TEST(Observe, AFullScanIsThinnedAndReportedWhole) {
  FastSlam slam = cloud(Association::likelihood_ratio);
  const core::StepReport report = observe(slam, ring_of(400));
  EXPECT_EQ(report.associations.size(), 400u);
  EXPECT_LE(slam.map().size(), core::most_observations_used);
  EXPECT_EQ(report.decisions.size(), 1u);
}

TEST(Observe, NegativeAndRepeatedLabelsAreRejectedAndTheFirstCounts) {
  FastSlam slam = cloud(Association::known);
  const core::StepReport report = observe_known(slam, ring_of(4), {7, -1, 7, 9});
  EXPECT_EQ(report.associations[0].outcome, core::Outcome::augmented);
  EXPECT_EQ(report.associations[1].outcome, core::Outcome::rejected);
  EXPECT_EQ(report.associations[2].outcome, core::Outcome::rejected);
  EXPECT_EQ(report.associations[3].outcome, core::Outcome::augmented);
  ASSERT_EQ(slam.map().size(), 2u);
  EXPECT_EQ(slam.name_of(slam.map()[0].id), 7);
  EXPECT_THROW(observe_known(slam, ring_of(4), {1, 2}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::fastslam
