// SPDX-License-Identifier: BSD-3-Clause
#include "association/rival_matchings.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

bool are_compatible(const OldPairs& old, int first, int second) {
  static const double gate = core::chi2_quantile(0.999, 4);
  if (old.at(first).candidate == old.at(second).candidate) return false;
  Eigen::Matrix4d S;
  S << old.covariance(first, first), old.covariance(first, second), old.covariance(second, first),
      old.covariance(second, second);
  Eigen::Vector4d nu;
  nu << old.innovation(first), old.innovation(second);
  return nu.dot(S.inverse() * nu) < gate;
}

/// The pairs of a few observations, spread over the scan.
std::vector<std::vector<int>> pairs_of_some_observations(const OldPairs& old, std::size_t most) {
  std::vector<std::vector<int>> by_observation;
  for (int k = 0; k < old.size(); ++k) {
    const bool another = k == 0 || old.at(k).observation != old.at(k - 1).observation;
    if (another) by_observation.emplace_back();
    by_observation.back().push_back(k);
  }
  if (by_observation.size() <= most) return by_observation;
  std::vector<std::vector<int>> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(by_observation[i * by_observation.size() / most]);
  return some;
}

/// Any two pairs of different observations, at least one of them not in the best matching; nothing if there are more than
/// `most`.
std::optional<std::vector<std::pair<int, int>>> starts(const std::vector<std::vector<int>>& some, const Matching& best,
                                                       std::size_t most) {
  const auto is_best = [&](int k) { return std::binary_search(best.begin(), best.end(), k); };
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const int a : some[i]) {
        for (const int b : some[j]) {
          if (is_best(a) && is_best(b)) continue;
          if (found.size() == most) return std::nullopt;
          found.emplace_back(a, b);
        }
      }
    }
  }
  return found;
}

bool is_rival(const Matching& best, const Matching& other) {
  Matching common;
  std::set_intersection(best.begin(), best.end(), other.begin(), other.end(), std::back_inserter(common));
  return 2 * common.size() < other.size() && 2 * other.size() >= best.size();
}

}  // namespace

std::optional<std::vector<Matching>> rival_matchings(const OldPairs& old, const Matching& best) {
  constexpr std::size_t observations = 8;
  constexpr std::size_t most_starts = 2000;
  const auto begun = starts(pairs_of_some_observations(old, observations), best, most_starts);
  if (!begun) return std::nullopt;
  std::set<Matching> rivals;
  for (const auto& [first, second] : *begun) {
    if (!are_compatible(old, first, second)) continue;
    Matching other = matching_given(old, first, second);
    if (is_rival(best, other)) rivals.insert(std::move(other));
  }
  return std::vector<Matching>(rivals.begin(), rivals.end());
}

}  // namespace helixnav::supervisor
