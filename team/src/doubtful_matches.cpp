// SPDX-License-Identifier: BSD-3-Clause
#include "doubtful_matches.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/joint_innovation.hpp"

namespace helixnav::team {
namespace {

using association::Assignment;
using association::GatedObservation;
using association::GatedPair;
using association::InnovationProblem;
using association::ObservationOutcome;
using association::Outcome;

double noise_m2(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
  const core::LocatedLandmark located = core::locate_landmark(observation, core::Pose2(), T_robot_sensor);
  return (located.G_z * observation.R * located.G_z.transpose()).trace();
}

std::vector<bool> found_in(const Assignment& assignment, std::size_t landmarks) {
  std::vector<bool> found(landmarks, false);
  for (const ObservationOutcome& one : assignment.observations) {
    if (one.outcome == Outcome::matched) found[static_cast<std::size_t>(one.candidate)] = true;
  }
  return found;
}

/// [observation] its match may equally be of another landmark, or of one that nobody has begun.
std::vector<bool> with_rivals(const core::Scan& scan, const InnovationProblem& problem,
                              const core::JointGaussian& joint, const association::Options& options,
                              const Assignment& assignment) {
  static const double needed_nats = std::log(20.0);
  const double detection_nats = std::log(options.detection_probability / (1.0 - options.detection_probability));
  const std::vector<bool> found = found_in(assignment, problem.ids.size());
  std::vector<bool> doubtful(assignment.observations.size(), false);
  for (std::size_t i = 0; i < doubtful.size(); ++i) {
    const ObservationOutcome& one = assignment.observations[i];
    if (one.outcome != Outcome::matched) continue;
    const double one_m2 = noise_m2(scan.observations[i], scan.T_robot_sensor);
    const Eigen::Vector2d& at_m = joint.points_m[static_cast<std::size_t>(one.candidate)];
    const auto begin = problem.pairs.begin() + problem.observations[i].begin;
    const auto end = problem.pairs.begin() + problem.observations[i].end;
    const auto own = std::find_if(begin, end, [&](const GatedPair& pair) { return pair.candidate == one.candidate; });
    const double new_nats = std::log(options.extraneous.of(problem.observations[i].kind)) - detection_nats;
    doubtful[i] = own->log_likelihood - new_nats < needed_nats || std::any_of(begin, end, [&](const GatedPair& other) {
                    const auto candidate = static_cast<std::size_t>(other.candidate);
                    return !found[candidate] && own->log_likelihood - other.log_likelihood < needed_nats &&
                           (joint.points_m[candidate] - at_m).squaredNorm() > one_m2;
                  });
  }
  return doubtful;
}

/// The problem without these pairs.
InnovationProblem without(const InnovationProblem& problem, const std::vector<int>& pairs) {
  InnovationProblem rest = problem;
  rest.pairs.clear();
  for (GatedObservation& observation : rest.observations) {
    const int begin = static_cast<int>(rest.pairs.size());
    for (int p = observation.begin; p < observation.end; ++p) {
      const bool is_left = std::find(pairs.begin(), pairs.end(), p) == pairs.end();
      if (is_left) rest.pairs.push_back(problem.pairs[static_cast<std::size_t>(p)]);
    }
    observation.begin = begin;
    observation.end = static_cast<int>(rest.pairs.size());
  }
  return rest;
}

/// ln of the likelihood of a matching against that of new objects only.
double nats_of_matching(const InnovationProblem& problem, const std::vector<int>& pairs,
                        const association::Options& options) {
  double nats = pairs.empty() ? 0.0 : association::joint_nis(problem, pairs).log_likelihood;
  const double detection_nats = std::log(options.detection_probability / (1.0 - options.detection_probability));
  for (const int pair : pairs) {
    const int of = problem.pairs[static_cast<std::size_t>(pair)].observation;
    const core::ObservationKind kind = problem.observations[static_cast<std::size_t>(of)].kind;
    nats += detection_nats - std::log(options.extraneous.of(kind));
  }
  return nats;
}

/// The landmark of each observation in the best joint matching, if no matching elsewhere comes near it; else none of any.
std::vector<int> decided_jointly(const InnovationProblem& problem, const association::Options& options) {
  static const double needed_nats = std::log(1000.0);
  std::vector<int> landmarks(problem.observations.size(), -1);
  const auto joint_matching = [&](const InnovationProblem& asked) {
    return association::associate(association::Method::joint_likelihood_ratio, asked, options);
  };
  const Assignment best = joint_matching(problem);
  const InnovationProblem elsewhere = without(problem, best.pairs);
  const Assignment rival = joint_matching(elsewhere);
  const double rival_nats = std::max(0.0, nats_of_matching(elsewhere, rival.pairs, options));
  const bool is_cut_short = best.budget_hit || rival.budget_hit;
  if (is_cut_short || nats_of_matching(problem, best.pairs, options) < rival_nats + needed_nats) return landmarks;
  for (const int pair : best.pairs) {
    const GatedPair& one = problem.pairs[static_cast<std::size_t>(pair)];
    landmarks[static_cast<std::size_t>(one.observation)] = one.candidate;
  }
  return landmarks;
}

}  // namespace

void leave_doubtful(const core::Scan& scan, const core::Scan& look, const core::JointGaussian& joint,
                    const association::Gates& gates, const association::Options& options, Assignment& assignment) {
  if (look.observations.empty()) return;
  core::JointGaussian wider = joint;
  wider.covariance *= rival_variance_factor;
  const InnovationProblem problem = association::make_innovation_problem(wider, look, gates);
  association::Options how = options;  // anything that is seen may be new
  how.extraneous =
      association::density_in_view(look, static_cast<double>(look.observations.size()), options.extraneous);
  const std::vector<bool> doubtful = with_rivals(scan, problem, joint, how, assignment);
  if (std::none_of(doubtful.begin(), doubtful.end(), [](bool one) { return one; })) return;
  const std::vector<int> decided = decided_jointly(problem, how);
  for (std::size_t i = 0; i < doubtful.size(); ++i) {
    ObservationOutcome& one = assignment.observations[i];
    if (doubtful[i] && decided[i] != one.candidate) one.outcome = Outcome::ambiguous;
  }
}

}  // namespace helixnav::team
