// SPDX-License-Identifier: BSD-3-Clause
#include "left_double.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Cholesky>

namespace helixnav::apps {
namespace {

struct PossibleCopy {
  double apart_m;
  std::size_t a, b;
};

/// [landmark] the sessions that have it, ascending.
std::vector<std::vector<std::size_t>> sessions_with(const supervisor::JoinedSessions& joined, std::size_t number) {
  const std::vector<core::LandmarkId>& ids = joined.components[number].joint.ids;
  std::vector<std::vector<std::size_t>> sessions(ids.size());
  for (std::size_t k = 0; k < joined.sessions.size(); ++k) {
    if (joined.sessions[k].component != number) continue;
    for (const auto& [own, name] : joined.sessions[k].name_of) {
      std::vector<std::size_t>& with =
          sessions[static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), name) - ids.begin())];
      if (with.empty() || with.back() != k) with.push_back(k);
    }
  }
  return sessions;
}

bool have_one_in_common(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

std::vector<PossibleCopy> possible_copies(const supervisor::JoinedSessions& joined, std::size_t number,
                                          double reach_m) {
  constexpr double surely = 9.21;  // χ²₂ of 99 %
  const core::JointMap& component = joined.components[number];
  const std::vector<std::vector<std::size_t>> sessions = sessions_with(joined, number);
  std::vector<PossibleCopy> copies;
  for (std::size_t a = 0; a < sessions.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (have_one_in_common(sessions[a], sessions[b])) continue;
      if (chi2_as_one(component, a, b, reach_m) >= surely) continue;
      copies.push_back({(component.joint.points_m[a] - component.joint.points_m[b]).norm(), a, b});
    }
  }
  std::stable_sort(copies.begin(), copies.end(), [](const auto& a, const auto& b) { return a.apart_m < b.apart_m; });
  return copies;
}

}  // namespace

double chi2_as_one(const core::JointMap& component, std::size_t a, std::size_t b, double reach_m) {
  constexpr double of_reach = 1.0 / 200.0;
  const auto block = [&](std::size_t one, std::size_t other) {
    return component.joint.covariance.block<2, 2>(3 + 2 * static_cast<Eigen::Index>(one),
                                                  3 + 2 * static_cast<Eigen::Index>(other));
  };
  const double seen_m = of_reach * reach_m;
  const Eigen::Matrix2d S =
      block(a, a) + block(b, b) - block(a, b) - block(b, a) + 2.0 * seen_m * seen_m * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d apart_m = component.joint.points_m[a] - component.joint.points_m[b];
  return apart_m.dot(S.ldlt().solve(apart_m));
}

std::vector<std::pair<core::LandmarkId, core::LandmarkId>> left_double(const supervisor::JoinedSessions& joined,
                                                                       std::size_t number, double reach_m) {
  const std::vector<core::LandmarkId>& ids = joined.components[number].joint.ids;
  std::vector<std::pair<core::LandmarkId, core::LandmarkId>> pairs;
  std::set<std::size_t> taken;
  for (const PossibleCopy& one : possible_copies(joined, number, reach_m)) {
    if (taken.count(one.a) + taken.count(one.b) > 0) continue;
    taken.insert({one.a, one.b});
    pairs.emplace_back(ids[one.b], ids[one.a]);
  }
  return pairs;
}

}  // namespace helixnav::apps
