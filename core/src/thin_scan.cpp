// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/thin_scan.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "helixnav/core/chi2.hpp"

namespace helixnav::core {
namespace {

/// Whether one object may have made both observations.
bool may_be_one(const Observation& a, const Observation& b, double gate) {
  if (a.kind != b.kind) return false;
  const ObsVector difference = innovation(a.kind, a.z, b.z);
  const ObsMatrix S = a.R + b.R;
  const Eigen::LLT<ObsMatrix> llt(S);
  return llt.info() == Eigen::Success && difference.dot(llt.solve(difference)) < gate;
}

/// All places, cut into as many stretches as observations are used: the first of every stretch, then the second of each, so
/// that whatever comes first is spread evenly.
std::vector<std::size_t> spread_order(std::size_t count) {
  constexpr std::size_t stretches = most_observations_used;
  std::vector<std::size_t> order;
  order.reserve(count);
  for (std::size_t offset = 0; order.size() < count; ++offset) {
    for (std::size_t k = 0; k < stretches; ++k) {
      const std::size_t i = k * count / stretches + offset;
      if (i < (k + 1) * count / stretches) order.push_back(i);
    }
  }
  return order;
}

}  // namespace

std::vector<std::size_t> observations_to_use(const Scan& scan) {
  const std::size_t count = scan.observations.size();
  std::vector<std::size_t> used;
  if (count <= most_observations_used) {
    used.resize(count);
    std::iota(used.begin(), used.end(), std::size_t{0});
    return used;
  }
  constexpr std::size_t most_tested = 200 * most_observations_used;  // more than that say nothing that these do not
  std::size_t tested = 0;
  static const double gates[] = {chi2_quantile(0.99, 1), chi2_quantile(0.99, 2)};
  for (const std::size_t i : spread_order(count)) {
    if (used.size() == most_observations_used || ++tested > most_tested) break;
    const Observation& candidate = scan.observations[i];
    const double gate = gates[dimension(candidate.kind) - 1];
    const bool known = std::any_of(used.begin(), used.end(),
                                   [&](std::size_t k) { return may_be_one(candidate, scan.observations[k], gate); });
    if (!known) used.push_back(i);
  }
  std::sort(used.begin(), used.end());
  return used;
}

Scan thinned(const Scan& scan, const std::vector<std::size_t>& used) {
  Scan thin{scan.t_ns, scan.T_robot_sensor, scan.field_of_view, {}};
  thin.observations.reserve(used.size());
  for (const std::size_t i : used) thin.observations.push_back(scan.observations[i]);
  return thin;
}

std::vector<AssociationReport> reports_of_none(std::size_t observations) {
  std::vector<AssociationReport> reports(observations);
  for (std::size_t i = 0; i < observations; ++i) {
    reports[i].observation = static_cast<int>(i);
    reports[i].outcome = Outcome::ambiguous;
    reports[i].nis = std::numeric_limits<double>::quiet_NaN();
    reports[i].margin_nats = std::numeric_limits<double>::infinity();
  }
  return reports;
}

void name_in_whole_scan(const std::vector<std::size_t>& used, std::vector<AssociationReport>& all,
                        std::vector<AssociationReport>& reports) noexcept {
  for (AssociationReport& report : reports) {
    report.observation = static_cast<int>(used[static_cast<std::size_t>(report.observation)]);
    all[static_cast<std::size_t>(report.observation)] = report;
  }
  std::swap(all, reports);
}

Decision thinning_decision(std::size_t observations, std::size_t used) {
  return OtherDecision{
      "scan", "thinned", {{"observations", static_cast<double>(observations)}, {"used", static_cast<double>(used)}}};
}

}  // namespace helixnav::core
