// SPDX-License-Identifier: BSD-3-Clause
#include "placing/still_there.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "association/candidates.hpp"
#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/likelihood_ratio.hpp"

namespace helixnav::supervisor {
namespace {

using association::GatedObservation;
using association::InnovationProblem;
using core::LandmarkId;

/// [candidate] the greatest log-likelihood of an observation in its gate, and that observation; −1: none.
struct Met {
  double log_likelihood = -std::numeric_limits<double>::infinity();
  int observation = -1;
};

std::vector<Met> met_landmarks(const InnovationProblem& problem) {
  std::vector<Met> met(problem.ids.size());
  for (const association::GatedPair& pair : problem.pairs) {
    Met& best = met[static_cast<std::size_t>(pair.candidate)];
    if (pair.log_likelihood > best.log_likelihood) best = {pair.log_likelihood, pair.observation};
  }
  return met;
}

}  // namespace

StillThere still_there(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                       const core::Pose2& T_before_now, const core::Scan& scan, const PathInterval& stopped,
                       const NavigatorOptions& options) {
  core::Scan from_before = scan;
  from_before.T_robot_sensor = core::compose(T_before_now, scan.T_robot_sensor);
  std::vector<LandmarkId> in_view = expected_in_view(filter, from_before, options.view_margin_m);
  const auto was_not_seen_then = [&](LandmarkId id) {
    const association::LandmarkRecord& record = existence.record(id);
    return record.born_path_m > stopped.until_m || record.last_seen_path_m < stopped.from_m;
  };
  in_view.erase(std::remove_if(in_view.begin(), in_view.end(), was_not_seen_then), in_view.end());

  const core::JointGaussian joint = filter.joint(in_view);
  const InnovationProblem problem = association::make_innovation_problem(joint, from_before);
  const double extraneous_per_scan = options.extraneous_per_scan;
  const double anywhere_per_scan = std::max(existence.seen_per_scan(), extraneous_per_scan);
  const association::ExtraneousDensity anywhere = association::density_in_view(scan, anywhere_per_scan, {});
  const double missing_nats = options.search.integrity.missing_nats;
  const double detected = 1.0 - std::exp(-missing_nats);
  StillThere there;
  there.elsewhere_nats = extraneous_per_scan - anywhere_per_scan;
  const std::vector<Met> met = met_landmarks(problem);
  for (std::size_t k = 0; k < met.size(); ++k) {
    if (met[k].observation < 0) {
      const bool is_mature = existence.record(problem.ids[k]).state == core::LandmarkState::mature;
      there.missing += is_mature;
      there.elsewhere_nats += is_mature ? missing_nats : 0.0;
      continue;
    }
    ++there.seen;
    const GatedObservation& observation = problem.observations[static_cast<std::size_t>(met[k].observation)];
    there.elsewhere_nats += std::log(anywhere.of(observation.kind) / detected) - met[k].log_likelihood;
  }
  for (const GatedObservation& observation : problem.observations) {
    if (observation.begin < observation.end) continue;
    ++there.unknown;
    there.elsewhere_nats += std::log(anywhere_per_scan / extraneous_per_scan);
  }
  return there;
}

}  // namespace helixnav::supervisor
