// SPDX-License-Identifier: BSD-3-Clause
// The loop of a session that does not know where it is on an earlier map.
#include <algorithm>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/navigation_loop.hpp"
#include "placing/join_maps.hpp"
#include "placing/placing_record.hpp"
#include "placing/session_question.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::PlacedDecision;

struct SeenLandmarks {
  std::vector<LandmarkId> confirmed, unconfirmed;
};

/// Of those in the filter: a window leaves out what is far away.
SeenLandmarks seen_landmarks(const Belief& belief, int least_hits) {
  SeenLandmarks seen;
  for (const association::LandmarkRecord& record : belief.existence.records()) {
    if (!belief.filter.contains(record.id)) continue;
    (record.hits >= least_hits ? seen.confirmed : seen.unconfirmed).push_back(record.id);
  }
  return seen;
}

/// What stood yesterday may be gone today: as sure as when it matured, and unseen for as long as anybody asks.
association::LandmarkRecord record_of(const EarlierMap& earlier, std::size_t landmark,
                                      const association::LifeOptions& life) {
  association::LandmarkRecord record;
  record.id = earlier.landmarks().ids[landmark];
  record.state = core::LandmarkState::mature;
  record.log_odds = life.mature_log_odds;
  record.observations = earlier.observations(landmark);
  record.hits = std::max(life.mature_looks, 1);
  record.last_hit_at_m = record.last_miss_at_m = earlier.landmarks().points_m[landmark];
  record.born_path_m = record.last_seen_path_m = -1e6;
  return record;
}

association::LandmarkLife existence_of_both(const association::LandmarkLife& session, const EarlierMap& earlier,
                                            const JoinedMaps& joined, const association::LifeOptions& life) {
  association::LandmarkLife both = session;
  both.change_frame(joined.T_map_session);
  for (std::size_t i = 0; i < earlier.landmarks().ids.size(); ++i) {
    const association::LandmarkRecord record = record_of(earlier, i, life);
    both.adopt(record);
    both.adopt_appearance(record.id, earlier.appearance().of(record.id));
  }
  for (const core::MergedLandmarks& one : joined.closing.merged) both.merge(one.kept, one.removed);
  for (const LandmarkId id : joined.closing.forgotten) both.remove(id);
  return both;
}

}  // namespace

void NavigationLoop::look_for_place_in(const core::JointMap& earlier) {
  if (belief_.step > 0 || belief_.filter.mapped_count() > 0 || earlier.next_name < 0) {
    throw core::PreconditionError("look_for_place_in: a session that has begun cannot look for its place any more");
  }
  check_earlier_map(earlier);
  if (std::count(earlier.states.begin(), earlier.states.end(), core::LandmarkState::mature) == 0)
    throw core::PreconditionError("look_for_place_in: no mature landmark in the map");
  auto map = std::make_shared<core::JointMap>(earlier);
  if (!goes_on_behind(earlier, options_.search)) map->factors = nullptr;
  apart_.maps = {{0, std::move(map)}};
  apart_.part = 1;
  apart_.next_part = 2;
  belief_.filter.name_from(earlier.next_name);
  std::get<Mapping>(mode_).trust(take_checkpoint(belief_, tape_));
}

relocalize::IndexOptions NavigationLoop::index_lengths() const {
  relocalize::IndexOptions lengths;
  lengths.reach_m = view_.reach().value_or(reference_reach_m);
  constexpr double most_share = 1.0 / 20.0;
  lengths.pair_noise_m = std::min(options_.search.constellation.branch_sigma_m, most_share * lengths.reach_m);
  return lengths;
}

/// The indices are built once the sensor is known. For an earlier session's map, the first scan reports that it is
/// sought.
void NavigationLoop::index_maps_apart(core::StepReport& report) {
  for (MapApart& apart : apart_.maps) {
    if (apart.search) continue;
    apart.search = std::make_shared<const PlaceSearch>(*apart.map, index_lengths());
    if (belief_.step > 1 || apart.part > 0) continue;
    PlacedDecision decision;
    decision.earlier_landmarks = static_cast<int>(apart.search->earlier().landmarks().ids.size());
    report.decisions.emplace_back(decision);
  }
}

/// After a scan, while there are maps whose pose relative to this one is not known.
void NavigationLoop::find_place(const core::FieldOfView& view, core::StepReport& report) {
  if (searching() != nullptr) return;
  index_maps_apart(report);
  const double seen_within_m = options_.search.branch_seen_within_m;
  LandmarksAbout about = landmarks_about(belief_, seen_within_m);
  if (!apart_.asked.is_due(about.ids)) {
    note_too_few(about.ids.size(), report);
    return;
  }
  const relocalize::Question question = session_question(belief_, about, view, index_lengths(), seen_within_m);
  if (question.looked.empty()) return;
  std::vector<PlacedDecision> answers;
  for (const MapApart& apart : apart_.maps) {
    PlacedDecision& decision = answers.emplace_back();
    decision.part = apart.part;
    if (!apart.search->can_be_asked() || !can_be_joined(apart)) continue;
    const relocalize::Answer answer = apart.search->ask(question, apart_.asked, decision);
    decision.driven_m = belief_.existence.path_m();
    if (answer.verdict == relocalize::Verdict::closed && join(apart, answer.places.front(), decision, report)) return;
  }
  report.decisions.reserve(report.decisions.size() + answers.size());
  for (const PlacedDecision& decision : answers) {
    if (decision.questions > 0) report.decisions.emplace_back(decision);  // the others cannot be asked
  }
  apart_.asked.note(about.ids);
}

/// A filter that holds a part of its map can only be put behind a drive.
bool NavigationLoop::can_be_joined(const MapApart& apart) const {
  return std::isinf(belief_.window.radius_m) || apart.search->earlier().drive() != nullptr;
}

/// Before the first question to an earlier session's map: reports the number of landmarks to ask with, whenever it is
/// the largest so far.
void NavigationLoop::note_too_few(std::size_t landmarks, core::StepReport& report) {
  if (apart_.asked.questions > 0 || apart_.maps.front().part > 0 || landmarks <= apart_.asked.most_about) return;
  PlacedDecision decision;
  decision.earlier_landmarks = static_cast<int>(apart_.maps.front().search->earlier().landmarks().ids.size());
  decision.landmarks = static_cast<int>(landmarks);
  decision.driven_m = belief_.existence.path_m();
  report.decisions.emplace_back(decision);
  apart_.asked.most_about = landmarks;
}

/// Of a large map: what the session may have seen of it.
core::JointGaussian NavigationLoop::landmarks_about_session(const EarlierMap& earlier,
                                                            const relocalize::Place& place) const {
  const auto most = static_cast<std::size_t>(options_.map.most);  // as much as a filter holds
  const Eigen::Vector2d here_m = belief_.filter.pose().mean.position_m();
  double farthest_m = 0.0;
  for (const LandmarkId id : belief_.filter.landmarks()) {
    farthest_m = std::max(farthest_m, (belief_.filter.landmark_mean(id) - here_m).norm());
  }
  const double reach_m = view_.reach().value_or(reference_reach_m);
  return earlier.landmarks_about(core::transform(place.T_map_branch, here_m), farthest_m + reach_m, most);
}

std::shared_ptr<const DriveMap> NavigationLoop::drive_by_its_end() const {
  const double phase_m = phase_length_m(view_.reach().value_or(reference_reach_m));
  return std::make_shared<const DriveMap>(DriveMap::of_end(belief_.filter.joint(belief_.filter.landmarks()), phase_m));
}

/// The drive so far, or if it is not known from its start what came of it, behind the one that made the map; null if the two
/// cannot be solved together.
std::shared_ptr<DriveMap> NavigationLoop::drive_behind(const EarlierMap& earlier, const core::Pose2& T_map_session,
                                                       const Closing& closing) const {
  try {
    const std::shared_ptr<const DriveMap> drive = is_drive_known() ? drive_until_now() : drive_by_its_end();
    return std::make_shared<DriveMap>(earlier.drive()->followed_by(*drive, T_map_session, closing.merged));
  } catch (const core::NumericalError&) {
    return nullptr;
  }
}

/// What is taken into the atlas needs a tape, whether or not a drive would be kept.
Tape NavigationLoop::tape_behind() const { return Tape(std::max(1, options_.search.smooth_up_to_scans)); }

/// As after a drive that has been taken into the atlas up to now.
void NavigationLoop::begin_behind(std::shared_ptr<DriveMap> drive, Belief& belief, Tape& tape) const {
  tape.append(Tape::Solved{drive->cost()});
  drive->begin_at(tape.end());
  tape.hand_on(tape.end());
  auto [filter, window] = begun_window(*drive, belief, window_about(belief.filter));
  drive->remember(belief.filter);
  belief.filter = std::move(filter);
  belief.window = window;
  belief.drive = std::move(drive);
}

JoinedMaps NavigationLoop::joined_at(const relocalize::Place& place, const PlaceSearch& search) const {
  const EarlierMap& earlier = search.earlier();
  const SeenLandmarks seen = seen_landmarks(belief_, options_.search.constellation.least_hits);
  core::JointGaussian about;
  if (earlier.drive()) about = landmarks_about_session(earlier, place);
  return join_maps(belief_.filter, earlier.drive() ? about : earlier.landmarks(), place, seen.confirmed,
                   seen.unconfirmed, search.lengths().pair_noise_m, options_.search);
}

/// What is believed on one map.
Belief NavigationLoop::belief_on_both(const EarlierMap& earlier, JoinedMaps joined,
                                      const core::Pose2& T_map_session) const {
  association::LandmarkLife existence = existence_of_both(belief_.existence, earlier, joined, options_.life);
  Belief both{std::move(joined.filter), std::move(existence), belief_.coverage, {}, belief_.step, belief_.slips,
              belief_.left_open};
  both.moving = belief_.moving;
  both.coverage.change_frame(T_map_session);
  return both;
}

/// From here on one map, in the frame of the earlier one, or everything as before. Behind a dense map, the drive so far can
/// no longer be solved as a whole, since it says nothing about how that map was made.
bool NavigationLoop::join(const MapApart& apart, const relocalize::Place& place, PlacedDecision& decision,
                          core::StepReport& report) {
  const EarlierMap& earlier = apart.search->earlier();
  JoinedMaps joined = joined_at(place, *apart.search);
  const Closing closing = joined.closing;
  decision.cost = closing.cost;
  decision.dof = closing.dof;
  decision.limit = closing.limit;
  decision.merged = static_cast<int>(closing.merged.size());
  decision.T_map_session = core::compose(joined.filter.pose().mean, core::inverse(belief_.filter.pose().mean));
  std::shared_ptr<DriveMap> drive;
  if (closing.accepted && earlier.drive()) drive = drive_behind(earlier, decision.T_map_session, closing);
  if (!closing.accepted || (earlier.drive() && !drive)) {
    decision.verdict = PlacedDecision::Verdict::refused;
    decision.T_map_session = place.T_map_branch;
    return false;
  }
  Belief both = belief_on_both(earlier, std::move(joined), decision.T_map_session);
  Tape tape = !drive || is_drive_known() ? tape_ : tape_behind();
  if (drive) {
    begin_behind(std::move(drive), both, tape);
    report.solved = both.drive->path();
  } else {
    tape.drop_drive();
  }
  tape.keep_since(tape.end());
  become_one(apart, std::move(both), std::move(tape), closing, decision, report);
  return true;
}

void NavigationLoop::become_one(const MapApart& apart, Belief both, Tape tape, const Closing& closing,
                                const PlacedDecision& decision, core::StepReport& report) {
  Mapping mapping;
  std::vector<LandmarkId> recognised;
  for (const core::MergedLandmarks& one : closing.merged) recognised.push_back(one.kept);
  mapping.monitor.close(both.existence.path_m(), recognised);
  mapping.trust(take_checkpoint(both, tape));
  report.merged.insert(report.merged.end(), closing.merged.begin(), closing.merged.end());
  report.pose = both.filter.pose();
  report.active_landmarks = both.filter.active_count();
  report.mapped_landmarks = both.filter.mapped_count();
  report.decisions.emplace_back(decision);
  MapsApart left = apart_;
  left.part = apart.part;
  left.placing = std::make_shared<const PlacingRecord>(
      PlacingRecord{start_, belief_, tape_, apart_, tape.end(), belief_.existence.path_m(),
                    std::min(decision.evidence, decision.lead), decision.T_map_session});
  const auto is_joined = [&](const MapApart& one) { return one.part == apart.part; };
  left.maps.erase(std::remove_if(left.maps.begin(), left.maps.end(), is_joined), left.maps.end());

  // Nothing below throws.
  belief_ = std::move(both);
  mode_ = std::move(mapping);
  questions_.place_again_at = 0;
  noise_.systematic.leave_tape();
  tape_ = std::move(tape);
  apart_ = std::move(left);
}

}  // namespace helixnav::supervisor
