// SPDX-License-Identifier: BSD-3-Clause
#include "slip/vanished.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "association/association_report.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::Outcome;

constexpr double assumed_share = 0.7;   ///< before anything is known, …
constexpr double assumed_looks = 20.0;  ///< … as if seen in so many looks
constexpr double most_share = 0.9;      ///< what hides one landmark may hide its neighbours
constexpr double by_chance = 0.05;      ///< a match after a slip
constexpr double keep = 1.0 - 1.0 / 200.0;
constexpr double scans_a_slip = 400.0;  ///< before anything is known
constexpr std::size_t least_missing = 2;
constexpr std::size_t least_unknown = 3;
constexpr std::size_t least_lasting = 2;
constexpr std::int64_t decided_after = 3;  ///< scans

std::size_t in_both(const std::vector<LandmarkId>& some, const std::vector<LandmarkId>& others) {
  return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [&others](LandmarkId id) {
    return std::find(others.begin(), others.end(), id) != others.end();
  }));
}

}  // namespace

double SeenAgain::share() const {
  return std::min(most_share, (again_ + assumed_share * assumed_looks) / (expected_ + assumed_looks));
}

Vanished SeenAgain::weigh(const std::vector<core::AssociationReport>& fate, const std::vector<LandmarkId>& expected,
                          const association::LandmarkLife& existence, double extraneous_per_scan) const {
  constexpr int well_known = 2;  // looks
  Vanished vanished;
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  vanished.unknown = landmarks_with(Outcome::augmented, fate);
  for (const LandmarkId id : last_) {
    if (!existence.contains(id) || existence.record(id).hits < well_known) continue;
    if (in_both({id}, matched) > 0) {
      ++vanished.seen;
    } else if (in_both({id}, expected) > 0) {
      vanished.missing.push_back(id);
    }
  }
  const double new_per_scan = existence.born_per_scan(extraneous_per_scan);
  const double known_per_scan = std::max(existence.seen_per_scan(), new_per_scan);
  const auto missing = static_cast<double>(vanished.missing.size());
  const auto unknown = static_cast<double>(vanished.unknown.size());
  vanished.nats = -missing * std::log(1.0 - share()) + vanished.seen * std::log(by_chance / share()) +
                  unknown * std::log(known_per_scan / new_per_scan) + new_per_scan - known_per_scan;
  return vanished;
}

void SeenAgain::count(const std::vector<core::AssociationReport>& fate, const std::vector<LandmarkId>& expected) {
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  again_ *= keep;
  expected_ *= keep;
  for (const LandmarkId id : last_) {
    const bool is_seen = in_both({id}, matched) > 0;
    again_ += is_seen ? 1.0 : 0.0;
    expected_ += is_seen || in_both({id}, expected) > 0 ? 1.0 : 0.0;
  }
}

/// If one of the landmarks is back, the vehicle is where odometry puts it.
void SeenAgain::judge(std::int64_t step, const std::vector<core::AssociationReport>& fate,
                      const std::vector<LandmarkId>& expected) {
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  const bool is_back = in_both(suspicion_->missing, matched) > 0;
  const bool is_away =
      in_both(suspicion_->missing, expected) > 0 && in_both(suspicion_->unknown, matched) >= least_lasting;
  if (is_away && !is_back) {
    is_confirmed_ = true;
  } else if (is_back || step - suspicion_->step >= decided_after) {
    suspicion_.reset();
  }
}

void SeenAgain::see(std::int64_t step, const std::vector<core::AssociationReport>& fate,
                    const std::vector<LandmarkId>& expected, const association::LandmarkLife& existence,
                    double extraneous_per_scan, int slips) {
  if (std::exchange(is_confirmed_, false)) suspicion_.reset();  // nothing came of it: too late to go back
  if (suspicion_) {
    judge(step, fate, expected);
  } else {
    const double needed = std::log((static_cast<double>(step) + scans_a_slip) / (static_cast<double>(slips) + 1.0));
    Vanished vanished = weigh(fate, expected, existence, extraneous_per_scan);
    vanished.step = step;
    const std::size_t missing = vanished.missing.size();
    const bool is_nearly_all = missing >= least_missing && missing >= 3 * static_cast<std::size_t>(vanished.seen);
    if (is_nearly_all && vanished.unknown.size() >= least_unknown && vanished.nats > needed)
      suspicion_ = std::move(vanished);
  }
  count(fate, expected);
  last_ = landmarks_with(Outcome::matched, fate);
  for (const LandmarkId id : landmarks_with(Outcome::augmented, fate)) last_.push_back(id);
}

void SeenAgain::start_from(const std::vector<core::AssociationReport>& fate) {
  suspicion_.reset();
  is_confirmed_ = false;
  last_ = landmarks_with(Outcome::matched, fate);
  for (const LandmarkId id : landmarks_with(Outcome::augmented, fate)) last_.push_back(id);
}

}  // namespace helixnav::supervisor
