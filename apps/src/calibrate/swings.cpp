// SPDX-License-Identifier: BSD-3-Clause
#include "swings.hpp"

#include <algorithm>

namespace helixnav::apps {
namespace {

Eigen::VectorXd in_sigmas(const Eigen::VectorXd& way, const Eigen::VectorXd& sigmas) {
  return (sigmas.array() > 0.0).select(way.cwiseAbs().cwiseQuotient(sigmas), 0.0);
}

double farthest(const Eigen::VectorXd& way, const Eigen::VectorXd& sigmas) {
  return way.size() > 0 ? in_sigmas(way, sigmas).maxCoeff() : 0.0;
}

}  // namespace

Eigen::VectorXd swings(const RoundValues& rounds, const Eigen::VectorXd& sigmas) {
  constexpr std::size_t last = 3;
  Eigen::VectorXd least = rounds.back(), most = rounds.back();
  for (std::size_t i = rounds.size() - std::min(last, rounds.size()); i < rounds.size(); ++i) {
    least = least.cwiseMin(rounds[i]);
    most = most.cwiseMax(rounds[i]);
  }
  return in_sigmas(most - least, sigmas);
}

bool repeats(const RoundValues& rounds, const Eigen::VectorXd& sigmas) {
  constexpr double same = 0.1;
  if (rounds.size() < 3) return false;
  const Eigen::VectorXd& now = rounds.back();
  if (farthest(now - rounds[rounds.size() - 2], sigmas) < same) return false;
  return std::any_of(rounds.begin(), rounds.end() - 2,
                     [&](const Eigen::VectorXd& then) { return farthest(now - then, sigmas) < same; });
}

}  // namespace helixnav::apps
