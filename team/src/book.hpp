// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "find_joins.hpp"
#include "find_same.hpp"
#include "helixnav/team/team.hpp"
#include "increments.hpp"
#include "process.hpp"

namespace helixnav::team {

/// The events in the order of processing, and checkpoints of what followed from them.
struct Team::Book {
  struct Checkpoint {
    std::size_t entries = 0;  ///< that the state rests on
    State state;
  };
  static constexpr std::size_t most_checkpoints = 8;

  explicit Book(const std::vector<std::optional<core::PoseGaussian>>& starts, const TeamOptions& given)
      : options(given),
        state(begin(starts)),
        first{0, state},
        increments(starts.size()),
        moved_until_ns(starts.size(), std::numeric_limits<core::Nanoseconds>::min()) {}

  std::optional<core::StepReport> enter(Entry entry);
  std::optional<core::StepReport> step(const Entry& entry);
  void solve_if_due(core::Nanoseconds t_ns);
  void solve_all(core::Nanoseconds t_ns);
  void rewind(std::size_t entries);
  std::optional<core::StepReport> replay();
  bool take_back_wrong_join();
  void start_again();
  void move(std::size_t robot, const core::Odometry& motion);
  void sight(std::size_t robot, const core::RobotSighting& sighting);
  void add_motion(std::size_t robot, const core::Odometry& motion);
  void end_motion_at(std::size_t robot, core::Nanoseconds t_ns);
  void replace_motions(std::size_t robot, const Increments::Pieces& pieces);
  void check_robot(int robot) const;

  TeamOptions options;
  State state;
  std::vector<Entry> entries;
  std::size_t done = 0;  ///< of the entries, in the state
  Checkpoint first;
  std::vector<Checkpoint> checkpoints;
  std::vector<Increments> increments;             ///< [robot]
  std::vector<core::Nanoseconds> moved_until_ns;  ///< [robot]
  std::vector<Entry> waiting;                     ///< sightings of robots that have not yet moved until then
  RefusedJoins refused;
  std::vector<TakenBackJoin> taken_back;
  RefusedSame refused_same;
};

}  // namespace helixnav::team
