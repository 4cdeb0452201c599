// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "update/iterate_and_apply.hpp"

namespace helixnav::cekf {

UpdateResult CompressedEkf::update_iterated(const std::vector<Match>& matches, int max_iterations) {
  const char* const verb = "update_iterated";
  check_matches(matches, verb);
  if (matches.empty()) return {};
  BeforeActivations before = before_activations(are_active(matches));
  try {
    for (const Match& match : matches) activate(match.landmark);
    name_landmarks(matches, workspace_);
    return iterate_and_apply(max_iterations, verb, [&](UpdateWorkspace& w) { linearise_sightings(matches, w, verb); });
  } catch (...) {
    undo_activations(before);
    throw;
  }
}

CostByPart CompressedEkf::iterated_cost(const std::vector<Match>& matches, int max_iterations) const {
  const char* const verb = "iterated_cost";
  check_matches(matches, verb);
  if (matches.empty()) return {};
  UpdateWorkspace w;
  name_landmarks(matches, w);
  gather_involved_unactivated(w);
  InvolvedCorrection correction(options_.retraction, w);
  const double cost = iterate_to_minimum(correction, w, max_iterations, verb,
                                         [&](UpdateWorkspace& at) { linearise_sightings(matches, at, verb); });
  if (!std::isfinite(cost)) return {cost, static_cast<int>(w.nu.rows()), {}};
  std::vector<int> rows;
  for (const Match& match : matches) rows.push_back(core::dimension(match.observation.kind));
  return {cost, static_cast<int>(w.nu.rows()), cost_by_part(w, rows)};
}

/// As gather_involved, for landmarks active or passive, from their read-only joint marginal.
void CompressedEkf::gather_involved_unactivated(UpdateWorkspace& w) const {
  const core::JointGaussian marginal = joint(w.ids);
  w.involved.clear();
  for (int column = 0; column < marginal.covariance.cols(); ++column) w.involved.push_back(column);
  w.pose = marginal.pose;
  w.points_m = marginal.points_m;
  w.P.resize(marginal.covariance.rows(), marginal.covariance.cols());
  w.P.view() = marginal.covariance;
}

}  // namespace helixnav::cekf
