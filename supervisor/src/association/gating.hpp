// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::supervisor {

/// What the filter expects a scan to look like; `appearance` is null if nothing is known about classes and sizes. Not
/// copyable, because the problem refers to the joint estimate next to it.
struct Gating {
  Gating(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& ids, const core::Scan& scan,
         const association::Gates& gates, const core::MapAppearance* appearance = nullptr)
      : joint(filter.joint(ids)), problem(association::make_innovation_problem(joint, scan, gates, appearance)) {}
  Gating(const Gating&) = delete;
  Gating& operator=(const Gating&) = delete;

  core::JointGaussian joint;
  association::InnovationProblem problem;
};

}  // namespace helixnav::supervisor
