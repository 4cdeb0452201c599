// SPDX-License-Identifier: BSD-3-Clause
#include "loop/tape.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "association/association_report.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

bool is_stop(const Tape::Entry& entry) {
  const auto* fix = std::get_if<Tape::Fix>(&entry);
  return std::holds_alternative<Tape::Scan>(entry) || (fix != nullptr && fix->accepted);
}

/// Measured or not; null for what is not a motion.
const core::Odometry* motion_of(const Tape::Entry& entry) {
  if (const auto* measured = std::get_if<Tape::Motion>(&entry)) return &measured->odometry;
  if (const auto* slip = std::get_if<Tape::Slip>(&entry)) return &slip->motion;
  return nullptr;
}

bool is_used(const core::AssociationReport& association) {
  return association.outcome == core::Outcome::matched || association.outcome == core::Outcome::augmented;
}

/// In place: code that frees memory must not fail for lack of it. (shrink_to_fit then leaves the vector as it is.)
void drop_unused(Tape::Scan& entry) {
  std::vector<core::Observation>& observations = entry.scan.observations;
  std::size_t used = 0;
  entry.fate.erase(std::remove_if(entry.fate.begin(), entry.fate.end(), std::not_fn(is_used)), entry.fate.end());
  for (core::AssociationReport& association : entry.fate) {
    observations[used] = observations[static_cast<std::size_t>(association.observation)];
    association.observation = static_cast<int>(used++);
  }
  observations.erase(observations.begin() + static_cast<std::ptrdiff_t>(used), observations.end());
  entry.fate.shrink_to_fit();
  observations.shrink_to_fit();
}

}  // namespace

void Tape::append(Entry entry) {
  stops_ += is_stop(entry);
  entries_.push_back(std::move(entry));
}

Tape Tape::rescaled(double observations, double odometry) const {
  Tape tape = *this;
  const double least = std::min(observations, odometry);
  for (Entry& entry : tape.entries_) {
    if (auto* motion = std::get_if<Motion>(&entry)) motion->odometry.covariance *= odometry;
    if (auto* solved = std::get_if<Solved>(&entry)) solved->cost /= least;
    if (auto* merge = std::get_if<Merge>(&entry)) merge->cost /= least;
    auto* scan = std::get_if<Scan>(&entry);
    if (scan == nullptr) continue;
    scan->nis /= least;
    for (core::Observation& observation : scan->scan.observations) observation.R *= observations;
  }
  return tape;
}

Tape Tape::with_wider_fixes(double widened) const {
  Tape tape = *this;
  for (Entry& entry : tape.entries_) {
    auto* fix = std::get_if<Fix>(&entry);
    if (fix == nullptr || fix->used.widened >= widened) continue;
    fix->used.fix.covariance_m2 *= widened / fix->used.widened;
    fix->used.widened = widened;
  }
  return tape;
}

Tape Tape::without(const SystematicErrors& errors) const {
  Tape tape = *this;
  for (Entry& entry : tape.entries_) {
    if (auto* motion = std::get_if<Motion>(&entry)) {
      motion->odometry = supervisor::without(errors, motion->odometry, motion->time);
    }
    if (auto* scan = std::get_if<Scan>(&entry)) scan->scan = supervisor::without(errors, std::move(scan->scan));
  }
  return tape;
}

Tape Tape::with_larger_noise(double odometry, double length_m, double ago_m) const {
  constexpr double rounding_m = 1e-6;
  Tape tape = *this;
  for (auto entry = tape.entries_.rbegin(); entry != tape.entries_.rend() && length_m > 0.0; ++entry) {
    auto* motion = std::get_if<Motion>(&*entry);
    if (motion == nullptr) continue;
    const bool is_since = ago_m > rounding_m;
    (is_since ? ago_m : length_m) -= motion->driven_m;
    if (!is_since) motion->odometry.covariance *= odometry;
  }
  return tape;
}

Tape Tape::with_jump(Position position, const core::Odometry& jump) const {
  Tape tape = *this;
  tape.entries_.insert(tape.entries_.begin() + static_cast<std::ptrdiff_t>(position - forgotten_), Slip{jump});
  return tape;
}

Tape Tape::without_matches_since(Position position, const std::set<core::LandmarkId>& but_with) const {
  const core::MergedIds ids = merged_ids(*this);
  Tape tape = *this;
  for (std::size_t i = position - std::min(position, forgotten_); i < tape.entries_.size(); ++i) {
    auto* scan = std::get_if<Scan>(&tape.entries_[i]);
    if (scan == nullptr) continue;
    for (core::AssociationReport& association : scan->fate) {
      const bool is_wrong =
          association.outcome == core::Outcome::matched && but_with.count(ids.now(association.landmark)) == 0;
      if (is_wrong) association.outcome = core::Outcome::ambiguous;
    }
  }
  return tape;
}

Tape Tape::without_last_merges() const {
  Tape tape = *this;
  while (!tape.entries_.empty() && std::holds_alternative<Merge>(tape.entries_.back())) tape.entries_.pop_back();
  return tape;
}

Tape Tape::without_last_solution() const {
  Tape tape = *this;
  const auto is_solution = [](const Entry& entry) { return std::holds_alternative<Solved>(entry); };
  const auto last = std::find_if(tape.entries_.rbegin(), tape.entries_.rend(), is_solution);
  if (last != tape.entries_.rend()) *last = Merge{};  // of nothing: positions stay
  return tape;
}

double Tape::cost_of_last_merges() const {
  double cost = 0.0;
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    const auto* merge = std::get_if<Merge>(&*entry);
    if (merge == nullptr) break;
    cost += merge->cost;
  }
  return cost;
}

std::vector<Tape::Entry> Tape::cut(Position position) {
  const auto from = entries_.begin() + static_cast<std::ptrdiff_t>(position - forgotten_);
  std::vector<Entry> taken(std::make_move_iterator(from), std::make_move_iterator(entries_.end()));
  entries_.erase(from, entries_.end());
  stops_ -= static_cast<int>(std::count_if(taken.begin(), taken.end(), is_stop));
  settled_ = std::min(settled_, position);
  return taken;
}

void Tape::settle(Position position) {
  if (kept_since_) position = std::min(position, *kept_since_);
  for (; settled_ < position; ++settled_) {
    if (auto* scan = std::get_if<Scan>(&entries_[settled_ - forgotten_])) drop_unused(*scan);
  }
  if (handed_on_ == 0 && stops_ > most_stops_) most_stops_ = 0;  // from now on
  forget(most_stops_ > 0 ? std::min(position, handed_on_) : position);
}

void Tape::forget(Position position) {
  if (position <= forgotten_) return;
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(position - forgotten_));
  forgotten_ = position;
}

void Tape::hand_on(Position position) {
  for (Position i = std::max(handed_on_, forgotten_); i < position; ++i) stops_ -= is_stop(entries_[i - forgotten_]);
  handed_on_ = std::max(handed_on_, position);
}

std::vector<cekf::Match> used_observations(const Tape::Scan& scan) {
  std::vector<cekf::Match> used = matches(scan.scan, scan.fate);
  for (const core::AssociationReport& association : scan.fate) {
    if (association.outcome != core::Outcome::augmented) continue;
    used.push_back({association.landmark, scan.scan.observations[static_cast<std::size_t>(association.observation)],
                    scan.scan.T_robot_sensor});
  }
  return used;
}

cekf::UpdateResult innovation_cost(const Tape& tape, Tape::Position position) {
  cekf::UpdateResult cost;
  tape.read_from(position, [&](const Tape::Entry& entry) {
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      cost.nis += scan->nis;
      cost.dof += scan->dof;
    }
  });
  return cost;
}

double drive_cost(const Tape& tape, Tape::Position position, double before) {
  double cost = before;
  tape.read_from(position, [&](const Tape::Entry& entry) {
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) cost += scan->nis;
    if (const auto* fix = std::get_if<Tape::Fix>(&entry)) cost += fix->accepted ? fix->nis : 0.0;
    if (const auto* merge = std::get_if<Tape::Merge>(&entry)) cost += merge->cost;
    if (const auto* solved = std::get_if<Tape::Solved>(&entry)) cost = solved->cost;
  });
  return cost;
}

core::MergedIds merged_ids(const Tape& tape, Tape::Position position) {
  core::MergedIds ids;
  tape.read_from(position, [&](const Tape::Entry& entry) {
    const auto* merge = std::get_if<Tape::Merge>(&entry);
    if (merge == nullptr) return;
    for (const core::MergedLandmarks& one : merge->merged) ids.merge(one);
  });
  return ids;
}

std::vector<Stop> stops_of(const Tape& tape, Tape::Position position) {
  return stops_between(tape, position, tape.end());
}

std::vector<Stop> stops_between(const Tape& tape, Tape::Position position, Tape::Position until) {
  std::vector<Stop> stops;
  std::optional<core::Odometry> motion;
  tape.read_between(position, until, [&](const Tape::Entry& entry) {
    if (const core::Odometry* moved = motion_of(entry)) motion = motion ? core::chain(*motion, *moved) : *moved;
    if (!is_stop(entry)) return;
    Stop& stop = stops.emplace_back();
    stop.motion = std::exchange(motion, std::nullopt);
    if (const auto* fix = std::get_if<Tape::Fix>(&entry)) {
      stop.t_ns = fix->used.fix.t_ns;
      stop.fix = fix->used.fix;
    }
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      stop.t_ns = scan->scan.t_ns;
      stop.seen = used_observations(*scan);
    }
  });
  return stops;
}

std::optional<core::Odometry> motion_after_stops(const Tape& tape, Tape::Position position) {
  std::optional<core::Odometry> motion;
  tape.read_from(position, [&](const Tape::Entry& entry) {
    if (const core::Odometry* moved = motion_of(entry)) motion = motion ? core::chain(*motion, *moved) : *moved;
    if (is_stop(entry)) motion.reset();
  });
  return motion;
}

}  // namespace helixnav::supervisor
