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
                       const core::Pose2& T_before_now, const core::Scan& scan, double lately_m,
                       double extraneous_per_scan, const NavigatorOptions& options) {
  core::Scan from_before = scan;
  from_before.T_robot_sensor = core::compose(T_before_now, scan.T_robot_sensor);
  std::vector<LandmarkId> expected = expected_in_view(filter, from_before, options.view_margin_m);
  const auto not_lately = [&](LandmarkId id) {
    const association::LandmarkRecord& record = existence.record(id);
    return record.state != core::LandmarkState::mature || existence.path_m() - record.last_seen_path_m > lately_m;
  };
  expected.erase(std::remove_if(expected.begin(), expected.end(), not_lately), expected.end());

  const core::JointGaussian joint = filter.joint(expected);
  const InnovationProblem problem = association::make_innovation_problem(joint, from_before);
  const double anywhere_per_scan = std::max(existence.seen_per_scan(), extraneous_per_scan);
  const association::ExtraneousDensity anywhere = association::density_in_view(scan, anywhere_per_scan, {});
  const double missing_nats = options.search.integrity.missing_nats;
  const double detected = 1.0 - std::exp(-missing_nats);
  StillThere there;
  there.elsewhere_nats = extraneous_per_scan - anywhere_per_scan;
  for (const Met& met : met_landmarks(problem)) {
    if (met.observation < 0) {
      ++there.missing;
      there.elsewhere_nats += missing_nats;
      continue;
    }
    ++there.seen;
    const GatedObservation& observation = problem.observations[static_cast<std::size_t>(met.observation)];
    there.elsewhere_nats += std::log(anywhere.of(observation.kind) / detected) - met.log_likelihood;
  }
  for (const GatedObservation& observation : problem.observations) {
    if (observation.begin < observation.end) continue;
    ++there.unknown;
    there.elsewhere_nats += std::log(anywhere_per_scan / extraneous_per_scan);
  }
  return there;
}

}  // namespace helixnav::supervisor
