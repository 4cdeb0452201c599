// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "helixnav/association/ihgr.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/evaluation/association_score.hpp"
#include "helixnav/sim/ihgr_circle.hpp"
#include "mapping_loop.hpp"

namespace helixnav::bench {

/// A method as it enters the reproduction. "As published": gate 6.63, no joint test of the pairs.
struct Contestant {
  std::string name;
  MappingOptions mapping;
};

inline std::vector<Contestant> ihgr_contestants() {
  using association::Method;
  MappingOptions as_published;
  as_published.association.joint_test = false;
  as_published.association.detection_probability = 0.95;
  as_published.gates.match_probability = core::chi2_cdf(association::ihgr_published_gate, 2);
  as_published.filter = {cekf::Retraction::standard, 1000.0, 100.0, 1000};
  MappingOptions ours = as_published;
  ours.association.joint_test = true;
  ours.gates = {};
  const auto with = [](MappingOptions options, Method method) {
    options.method = method;
    return options;
  };
  MappingOptions assignment_alone = with(ours, Method::likelihood_ratio);
  assignment_alone.association.joint_test = false;
  return {{"nearest-neighbour", with(as_published, Method::nearest_neighbour)},
          {"nearest-neighbour-unique", with(as_published, Method::nearest_neighbour_unique)},
          {"ihgr-published", with(as_published, Method::ihgr_published)},
          {"likelihood-ratio, no joint test", assignment_alone},
          {"likelihood-ratio", with(ours, Method::likelihood_ratio)},
          {"jcbb", with(ours, Method::jcbb)},
          {"joint-likelihood-ratio", with(ours, Method::joint_likelihood_ratio)}};
}

/// The verdicts on one layout: "no wrong association", "pose consistent at the end" (NEES within the 99.9 % quantile of
/// χ²₃), and "12 features make 12 landmarks", the last a looser criterion for a good map.
struct Verdict {
  evaluation::AssociationScore score;
  bool without_wrong = false;
  bool consistent = false;
  bool one_landmark_each = false;
  double error_m = 0.0;
};

inline Verdict judge(const core::Recording& recording, const MappingRun& run) {
  Verdict verdict;
  verdict.score = evaluation::score_associations(run.steps, recording.labels, run.map);
  verdict.without_wrong = verdict.score.wrong == 0;
  const core::Pose2& truth = recording.true_poses.back().T_world_robot;
  Eigen::Vector3d error = run.pose.mean.vector() - truth.vector();
  error.z() = core::wrap_to_pi(error.z());
  const Eigen::LLT<Eigen::Matrix3d> llt(run.pose.covariance);
  verdict.consistent = llt.info() == Eigen::Success && error.dot(llt.solve(error)) <= core::chi2_quantile(0.999, 3);
  verdict.one_landmark_each = run.map.size() == verdict.score.labels_seen;
  verdict.error_m = error.head<2>().norm();
  return verdict;
}

inline Verdict run_layout(const sim::IhgrCircle& world, std::uint64_t seed, const MappingOptions& mapping) {
  const core::Recording recording = sim::simulate_ihgr_circle(world, seed);
  return judge(recording, map_along(recording.start, recording.events, mapping));
}

}  // namespace helixnav::bench
