// SPDX-License-Identifier: BSD-3-Clause
#include "report_clouds.hpp"

#include "packed.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {

Json clouds_data(const runs::Run& run) {
  std::size_t particles = 0;
  for (const core::StepReport& step : run.steps) particles += step.cloud.size();
  const std::size_t stride = stride_for(particles, most_particles);
  std::vector<std::int64_t> at, count, x, y, heading;
  for (const core::StepReport& step : run.steps) {
    if (step.cloud.empty()) continue;
    at.push_back(step.step);
    count.push_back(static_cast<std::int64_t>((step.cloud.size() + stride - 1) / stride));
    for (std::size_t i = 0; i < step.cloud.size(); i += stride) {
      x.push_back(quantised(step.cloud[i].x_m, 0.01));
      y.push_back(quantised(step.cloud[i].y_m, 0.01));
      heading.push_back(quantised(step.cloud[i].heading_rad, 1e-3));
    }
  }
  return {{"step", packed(at, 1)}, {"count", packed(count, 1)},     {"x", packed(x, 1)},
          {"y", packed(y, 1)},     {"heading", packed(heading, 1)}, {"stride", stride}};
}

}  // namespace helixnav::reports
