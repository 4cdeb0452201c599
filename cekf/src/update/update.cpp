// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "update/innovation.hpp"

namespace helixnav::cekf {

void CompressedEkf::check_matches(const std::vector<Match>& matches, const char* verb) const {
  for (const Match& match : matches) {
    place_of(match.landmark, verb);
    check_observation_of(match, verb);
  }
}

bool CompressedEkf::are_active(const std::vector<Match>& matches) const {
  return std::all_of(matches.begin(), matches.end(), [&](const Match& match) { return is_active(match.landmark); });
}

UpdateResult CompressedEkf::update(const std::vector<Match>& matches) {
  return *update_within(matches, std::numeric_limits<double>::infinity());
}

std::optional<UpdateResult> CompressedEkf::update_within(const std::vector<Match>& matches, double most_nis) {
  check_matches(matches, "update");
  if (matches.empty()) return UpdateResult{};
  BeforeActivations before = before_activations(are_active(matches));
  try {
    for (const Match& match : matches) activate(match.landmark);
    UpdateWorkspace& w = workspace_;
    name_landmarks(matches, w);
    gather_involved(w);
    linearise_sightings(matches, w, "update");
    const double nis = solve_innovation(w, "update");
    if (nis > most_nis) {
      undo_activations(before);
      return std::nullopt;
    }
    apply_correction(w, "update");
    active_.last_seen = static_cast<int>(w.ids.size());
    return UpdateResult{nis, static_cast<int>(w.nu.rows())};
  } catch (...) {
    undo_activations(before);
    throw;
  }
}

Innovation CompressedEkf::innovation(const std::vector<Match>& matches) const {
  const char* const verb = "innovation";
  check_matches(matches, verb);
  UpdateWorkspace w;
  name_landmarks(matches, w);
  gather_involved_unactivated(w);
  linearise_sightings(matches, w, verb);
  const auto H = w.H.view();
  return {w.nu.view(), H * w.P.view() * H.transpose() + Eigen::MatrixXd(w.R.view())};
}

/// Mean and covariance of the vehicle and of the landmarks named in w.ids, all active.
void CompressedEkf::gather_involved(UpdateWorkspace& w) const {
  w.involved.assign({0, 1, 2});
  w.points_m.clear();
  for (const core::LandmarkId id : w.ids) {
    const int index = find_place(id)->index;
    w.involved.push_back(ActivePart::column(index));
    w.involved.push_back(ActivePart::column(index) + 1);
    w.points_m.push_back(active_.points_m[static_cast<std::size_t>(index)]);
  }
  w.pose = active_.pose;
  const Eigen::Index n = static_cast<Eigen::Index>(w.involved.size());
  w.P.resize(n, n);
  const auto P = active_.P.view();
  auto P_involved = w.P.view();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      P_involved(i, j) = P(w.involved[static_cast<std::size_t>(i)], w.involved[static_cast<std::size_t>(j)]);
    }
  }
}

}  // namespace helixnav::cekf
