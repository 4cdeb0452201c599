// SPDX-License-Identifier: BSD-3-Clause
#include "book.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "solve.hpp"
#include "wrong_join.hpp"

namespace helixnav::team {
namespace {

/// Components into which others were joined.
std::set<std::size_t> joined_since(std::size_t joins, const State& state) {
  std::set<std::size_t> components;
  for (std::size_t j = joins; j < state.joins.size(); ++j) {
    components.insert(state.robots[static_cast<std::size_t>(state.joins[j].robot)].component);
  }
  return components;
}

bool is_same(const Entry& a, const Entry& b) {
  if (a.robot != b.robot || a.what.index() != b.what.index() || a.t_ns() != b.t_ns()) return false;
  const auto* one = std::get_if<core::Odometry>(&a.what);
  if (one == nullptr) return true;
  const auto& other = std::get<core::Odometry>(b.what);
  return one->T_before_after.vector() == other.T_before_after.vector() && one->covariance == other.covariance;
}

/// Entries of a stretch of time, with these motions instead of the robot's.
std::vector<Entry> with_motions(std::size_t robot, const std::vector<core::Odometry>& motions,
                                std::vector<Entry> entries) {
  const auto is_motion = [&](const Entry& entry) {
    return entry.robot == robot && std::holds_alternative<core::Odometry>(entry.what);
  };
  entries.erase(std::remove_if(entries.begin(), entries.end(), is_motion), entries.end());
  for (const core::Odometry& motion : motions) entries.push_back({robot, motion});
  std::stable_sort(entries.begin(), entries.end(), before);
  return entries;
}

}  // namespace

std::optional<core::StepReport> Team::Book::enter(Entry entry) {
  const auto place = std::upper_bound(entries.begin(), entries.end(), entry, before);
  const auto index = static_cast<std::size_t>(place - entries.begin());
  const bool late = index < done;
  entries.insert(place, std::move(entry));
  try {
    if (!late) {
      done = index + 1;
      std::optional<core::StepReport> report = step(entries[index]);
      return take_back_wrong_join() ? replay() : report;
    }
    rewind(index);
    replay();
  } catch (...) {
    entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(index));
    rewind(index);
    replay();
    throw;
  }
  return std::nullopt;
}

std::optional<core::StepReport> Team::Book::step(const Entry& entry) {
  solve_if_due(entry.t_ns());
  std::optional<core::StepReport> report = process(entry, options, state);
  if (report) report->merged = std::exchange(state.merged, {});
  return report;
}

void Team::Book::solve_if_due(core::Nanoseconds t_ns) {
  if (!state.next_solve_ns) {
    state.begin_ns = t_ns;
    state.next_solve_ns = t_ns + core::nanoseconds_from_seconds(options.solve_every_s);
  }
  if (t_ns < *state.next_solve_ns) return;
  solve_all(t_ns);
  const double so_far_s = core::seconds(t_ns - state.begin_ns);
  state.next_solve_ns =
      t_ns + core::nanoseconds_from_seconds(std::max(options.solve_every_s, options.solve_share * so_far_s));
  checkpoints.push_back({done - 1, state});
  if (checkpoints.size() > most_checkpoints) checkpoints.erase(checkpoints.begin());
}

void Team::Book::solve_all(core::Nanoseconds t_ns) {
  drop_seen_once(state);
  std::vector<std::size_t> solved;
  for (std::size_t c = 0; c < state.components.size(); ++c) {
    if (state.components[c].news && helixnav::team::solve(c, state)) solved.push_back(c);
  }
  if (options.join.by_place) {
    for (const std::size_t c : solved) find_same(c, t_ns, options, refused_same, state);
  }
  const std::size_t joins = state.joins.size();
  find_joins(t_ns, options, refused, state);
  if (options.join.by_place) {
    for (const std::size_t c : joined_since(joins, state)) find_same(c, t_ns, options, refused_same, state);
  }
}

void Team::Book::start_again() {
  checkpoints.clear();
  rewind(0);
  replay();
}

/// Rolls back to a checkpoint that rests on no entry from `entries_kept` on, nor was taken because of one of them.
void Team::Book::rewind(std::size_t entries_kept) {
  while (!checkpoints.empty() && checkpoints.back().entries >= entries_kept) checkpoints.pop_back();
  const Checkpoint& from = checkpoints.empty() ? first : checkpoints.back();
  state = from.state;
  done = from.entries;
}

std::optional<core::StepReport> Team::Book::replay() {
  std::optional<core::StepReport> report;
  while (done < entries.size()) {
    ++done;
    report = step(entries[done - 1]);
    take_back_wrong_join();
  }
  return report;
}

/// True if one was found: all that followed from it is undone, and everything has to be processed again.
bool Team::Book::take_back_wrong_join() {
  if (!state.news_of_joins) return false;
  state.news_of_joins = false;
  const std::optional<WrongJoin> wrong = find_wrong_join(state);
  if (!wrong) return false;
  refuse(wrong->join, state, refused);
  taken_back.push_back({state.joins[wrong->join], entries[done - 1].t_ns(), wrong->refused, wrong->seen});
  checkpoints.clear();
  rewind(0);
  return true;
}

/// Motion, and the sightings that waited for it.
void Team::Book::move(std::size_t robot, const core::Odometry& motion) {
  add_motion(robot, motion);
  moved_until_ns[robot] = std::max(moved_until_ns[robot], motion.t_ns);
  std::vector<Entry> still;
  std::vector<Entry> due;
  for (Entry& entry : waiting) {
    const auto& sighting = std::get<core::RobotSighting>(entry.what);
    const bool reached = static_cast<std::size_t>(sighting.seen) != robot || sighting.t_ns > motion.t_ns;
    (reached ? still : due).push_back(std::move(entry));
  }
  waiting = std::move(still);
  for (const Entry& entry : due) sight(entry.robot, std::get<core::RobotSighting>(entry.what));
}

void Team::Book::sight(std::size_t robot, const core::RobotSighting& sighting) {
  const auto seen = static_cast<std::size_t>(sighting.seen);
  if (moved_until_ns[seen] < sighting.t_ns) {
    waiting.push_back({robot, sighting});
    return;
  }
  end_motion_at(seen, sighting.t_ns);
  enter({robot, sighting});
}

void Team::Book::add_motion(std::size_t robot, const core::Odometry& motion) {
  const bool is_last = increments[robot].ends_after_all(motion.t_ns);
  const std::size_t place = increments[robot].add(motion);
  try {
    if (is_last) {
      enter({robot, motion});
    } else {
      replace_motions(robot, increments[robot].pieces_about(motion.t_ns));
    }
  } catch (...) {
    increments[robot].take_out(place);
    throw;
  }
}

/// Cuts the increment that the robot was in the middle of.
void Team::Book::end_motion_at(std::size_t robot, core::Nanoseconds t_ns) {
  if (!increments[robot].cut(t_ns)) return;
  try {
    replace_motions(robot, increments[robot].pieces_about(t_ns));
  } catch (...) {
    increments[robot].mend(t_ns);
    throw;
  }
}

/// Processes again what follows from the first piece that is another one.
void Team::Book::replace_motions(std::size_t robot, const Increments::Pieces& pieces) {
  const auto by_time = [](core::Nanoseconds t_ns, const Entry& entry) { return t_ns < entry.t_ns(); };
  const auto begin = std::upper_bound(entries.begin(), entries.end(), pieces.after_ns, by_time);
  const auto end = std::upper_bound(begin, entries.end(), pieces.until_ns, by_time);
  const std::vector<Entry> old(begin, end);
  const std::vector<Entry> now = with_motions(robot, pieces.motions, old);
  const auto first = static_cast<std::size_t>(begin - entries.begin());
  const auto same = static_cast<std::size_t>(
      std::mismatch(old.begin(), old.end(), now.begin(), now.end(), is_same).first - old.begin());
  const auto put = [&](const std::vector<Entry>& window, std::size_t instead_of) {
    const auto at = entries.begin() + static_cast<std::ptrdiff_t>(first);
    entries.insert(entries.erase(at, at + static_cast<std::ptrdiff_t>(instead_of)), window.begin(), window.end());
    rewind(first + same);
    replay();
  };
  try {
    put(now, old.size());
  } catch (...) {
    put(old, now.size());
    throw;
  }
}

void Team::Book::check_robot(int robot) const {
  if (robot >= 0 && static_cast<std::size_t>(robot) < state.robots.size()) return;
  throw core::PreconditionError("team: there is no robot " + std::to_string(robot));
}

}  // namespace helixnav::team
