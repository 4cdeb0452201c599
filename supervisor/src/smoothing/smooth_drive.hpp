// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/smoothing/problem.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// The result of solving the drive as a whole.
struct Smoothing {
  std::optional<cekf::CompressedEkf> solved;  ///< nothing when not accepted
  std::vector<core::StampedPose> path;        ///< at the solution, of every scan and fix used
  double chi2 = 0.0;                          ///< least squares' cost at its solution
  double limit = 0.0;                         ///< what it must not exceed
  int poses = 0;
  int iterations = 0;
  bool failed = false;  ///< not accepted because the mathematics failed
};

/// The filter at the least-squares solution of the whole drive with the associations known now, and with the covariance
/// of all measurements linearised there, from the factorisation that least squares ended with. After a closing that turned a
/// part of the map by many degrees the filter is linearised where that part was drawn, and no retraction of its own undoes
/// that (docs/adr/0010-solving-the-drive.md). Not accepted: no convergence, or a minimum that costs more than the filter's
/// own solution, which is then another one. Landmarks keep their ids. Cost: a few sparse factorisations and N² times the
/// nonzeros of their factor a landmark; ADR 10 has milliseconds. Test: supervisor/smoothing/smooth_drive_test.cpp (a filter that
/// drives along the solution).
/// `displaced`: landmarks that the filter has at a wrong place, from where least squares would not find the right one.
Smoothing smooth_drive(const cekf::CompressedEkf& filter, const core::PoseGaussian& start, const Tape& tape,
                       const std::set<core::LandmarkId>& displaced = {});

/// χ² by which the cost of a solution may exceed the filter's.
double slack();

/// What is added to standard deviations in (x, y, heading) so that every covariance has an inverse [m, m, rad].
Eigen::Vector3d softening();

/// The graph with what holds the start, and with covariances of which every one has an inverse.
smoothing::Problem problem_of(const core::PoseGaussian& start, core::LandmarkGraph graph);

}  // namespace helixnav::supervisor
