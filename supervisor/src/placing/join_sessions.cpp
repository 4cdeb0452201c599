// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/join_sessions.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "helixnav/core/merged_ids.hpp"
#include "helixnav/relocalize/elsewhere.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "placing/asked.hpp"
#include "placing/earlier_map.hpp"
#include "placing/join_drives.hpp"
#include "placing/join_maps.hpp"
#include "placing/map_questions.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

constexpr double alpha_a_pair = 1e-5;  ///< of a false answer for one pair of sessions

relocalize::IndexOptions lengths_of(const NavigatorOptions& options, double reach_m) {
  constexpr double most_share = 1.0 / 20.0;
  return {reach_m, std::min(options.search.constellation.branch_sigma_m, most_share * reach_m)};
}

relocalize::AskOptions options_for(std::size_t questions) {
  return session_options(alpha_a_pair / static_cast<double>(std::max<std::size_t>(1, questions)));
}

struct AnsweredQuestion {
  relocalize::Answer answer;
  relocalize::Question question;
};

/// All answers: closed ones first, the surest first within each group. What else the map repeats is not asked yet: in a vineyard that
/// takes seconds for each.
std::vector<AnsweredQuestion> ask_for(const EarlierMap& session, const relocalize::MapIndex& index,
                                      const std::function<void()>& now_and_then) {
  std::vector<relocalize::Question> questions = map_questions(session, index.options());
  const relocalize::AskOptions options = options_for(questions.size());
  std::vector<AnsweredQuestion> answers;
  for (relocalize::Question& question : questions) {
    now_and_then();
    relocalize::Answer answer = relocalize::ask(index, question, options);
    answers.push_back({std::move(answer), std::move(question)});
  }
  std::stable_sort(answers.begin(), answers.end(), [](const AnsweredQuestion& a, const AnsweredQuestion& b) {
    const auto rank = [](const AnsweredQuestion& asked) {
      return std::make_pair(static_cast<int>(asked.answer.verdict), -asked.answer.gap);
    };
    return rank(a) < rank(b);
  });
  return answers;
}

/// The session under names that the component does not use.
core::JointGaussian renamed(const EarlierMap& session, LandmarkId from) {
  core::JointGaussian joint = session.landmarks();
  for (LandmarkId& id : joint.ids) id += from;
  return joint;
}

/// The drive that made a session's map, under the same names; null if the map holds no factors.
std::shared_ptr<const DriveMap> drive_of(core::JointMap map, LandmarkId from) {
  if (map.factors == nullptr) return nullptr;
  auto factors = std::make_shared<core::MapFactors>(*map.factors);
  for (auto& [id, variable] : factors->landmarks) id += from;
  for (LandmarkId& id : map.joint.ids) id += from;
  map.next_name += from;
  map.factors = std::move(factors);
  return std::make_shared<const DriveMap>(DriveMap::of_earlier(map, phase_length_m(mapped_reach_m(map))));
}

/// All landmarks active: the pairs are all over the map, and nothing is to be left passive and updated later.
cekf::FilterOptions without_regions(cekf::FilterOptions options, std::size_t landmarks) {
  constexpr double whole_world_m = 1e9;
  options.cell_side_m = whole_world_m;
  options.max_active_landmarks = std::max(options.max_active_landmarks, static_cast<int>(landmarks));
  return options;
}

core::PlacedDecision nothing_asked(std::size_t questions, const core::JointMap& component) {
  core::PlacedDecision decision;
  decision.verdict = core::PlacedDecision::Verdict::not_here;
  decision.earlier_landmarks = static_cast<int>(component.joint.ids.size());
  decision.questions = static_cast<int>(questions);
  decision.needed = relocalize::evidence_needed(options_for(questions));
  return decision;
}

void note(const AnsweredQuestion& asked, core::PlacedDecision& decision) {
  const relocalize::Answer& answer = asked.answer;
  decision.landmarks = static_cast<int>(asked.question.landmarks.size());
  if (answer.verdict == relocalize::Verdict::ambiguous) decision.verdict = core::PlacedDecision::Verdict::ambiguous;
  decision.lead = answer.gap;
  if (answer.places.empty()) return;
  decision.pairs = static_cast<int>(answer.places.front().pairs.size());
  decision.evidence = answer.places.front().evidence;
  decision.T_map_session = answer.places.front().T_map_branch;
}

void note(const Closing& closing, core::PlacedDecision& decision) {
  decision.cost = closing.cost;
  decision.dof = closing.dof;
  decision.limit = closing.limit;
  decision.merged = static_cast<int>(closing.merged.size());
  decision.verdict =
      closing.accepted ? core::PlacedDecision::Verdict::accepted : core::PlacedDecision::Verdict::refused;
}

void tell_appearances(const core::MapAppearance& appearance, core::JointMap& map) {
  map.appearances.clear();
  if (appearance.is_empty()) return;
  for (const LandmarkId id : map.joint.ids) map.appearances.push_back(appearance.of(id));
}

core::MergedIds merged_by(const JoinedMaps& joined) {
  core::MergedIds now;
  for (const core::MergedLandmarks& one : joined.closing.merged) now.merge(one);
  return now;
}

/// Of the component, by what each landmark is now.
std::map<LandmarkId, int> observations_of(const core::JointMap& component, const core::MergedIds& now) {
  std::map<LandmarkId, int> observations;
  for (std::size_t i = 0; i < component.joint.ids.size(); ++i) {
    observations[now.now(component.joint.ids[i])] += component.observations[i];
  }
  return observations;
}

core::MapAppearance appearance_of(const core::JointMap& component, const core::MergedIds& now) {
  const core::MapAppearance before = EarlierMap(component).appearance();
  core::MapAppearance appearance = before;
  for (const LandmarkId id : component.joint.ids) {
    const LandmarkId kept = now.now(id);
    if (kept != id) appearance.adopt(kept, core::fused(appearance.of(kept), before.of(id)));
  }
  return appearance;
}

/// The component with the session in it. Merged landmarks keep the component's name and count as observed as often as
/// both.
void take_in(const EarlierMap& session, const JoinedMaps& joined, JoinedSession& result, core::JointMap& component) {
  const LandmarkId offset = component.next_name;
  const core::MergedIds now = merged_by(joined);
  std::map<LandmarkId, int> observations = observations_of(component, now);
  for (std::size_t i = 0; i < session.landmarks().ids.size(); ++i) {
    const LandmarkId own = session.landmarks().ids[i];
    const LandmarkId name = now.now(own + offset);
    if (!joined.filter.contains(name)) continue;
    result.name_of[own] = name;
    observations[name] += session.observations(i);
  }
  core::MapAppearance appearance = appearance_of(component, now);
  for (const auto& [own, name] : result.name_of) {
    appearance.adopt(name, core::fused(appearance.of(name), session.appearance().of(own)));
  }
  component.joint = joined.filter.joint(joined.filter.landmarks());
  component.next_name = offset + session.next_name();
  component.states.assign(component.joint.ids.size(), core::LandmarkState::mature);
  component.observations.clear();
  for (const LandmarkId id : component.joint.ids) component.observations.push_back(observations[id]);
  tell_appearances(appearance, component);
}

/// If both hold factors, what was joined to first order becomes the solution of both drives. The factors of both, or null.
std::shared_ptr<const core::MapFactors> solve_together(const EarlierMap& earlier, const core::JointMap& session,
                                                       const std::vector<LandmarkId>& of_session,
                                                       const SearchOptions& within, const SearchOptions& across,
                                                       JoinedMaps& joined) {
  const std::shared_ptr<const DriveMap> drive = drive_of(session, earlier.next_name());
  if (earlier.drive() == nullptr || drive == nullptr) return nullptr;
  std::optional<JoinedDrives> solved =
      join_drives(*earlier.drive(), earlier.landmarks().ids, *drive, of_session, joined, within, across);
  if (!solved) return nullptr;
  joined = std::move(solved->maps);
  return solved->factors;
}

/// Tries the surest places until one is accepted. `now`: what landmarks of the component have become.
bool place_in(const core::JointMap& session_map, const std::function<void()>& now_and_then, JoinedSession& result,
              core::JointMap& component, core::MergedIds& now) {
  const EarlierMap session(session_map);
  const EarlierMap earlier(component);
  const double reach_m = component.reach_m > 0.0 ? component.reach_m : reference_reach_m;
  core::FieldOfView view;
  view.max_range_m = reach_m;
  const NavigatorOptions options = fit_lengths(NavigatorOptions{}, view);
  const relocalize::IndexOptions lengths = lengths_of(options, reach_m);
  const relocalize::MapIndex index = earlier.index(lengths);
  std::vector<AnsweredQuestion> answers = ask_for(session, index, now_and_then);
  result.decision = nothing_asked(answers.size(), component);
  if (!answers.empty()) note(answers.front(), result.decision);
  if (answers.empty() || answers.front().answer.verdict != relocalize::Verdict::closed) return false;
  const LandmarkId offset = component.next_name;
  const core::JointGaussian joint = renamed(session, offset);
  const std::size_t together = joint.ids.size() + earlier.landmarks().ids.size();
  const cekf::CompressedEkf filter(joint, offset + session.next_name(), without_regions(options.filter, together));
  constexpr std::size_t most_tried = 3;
  std::size_t tried = 0;
  for (AnsweredQuestion& asked : answers) {
    if (asked.answer.verdict != relocalize::Verdict::closed || tried == most_tried) break;
    now_and_then();
    relocalize::judge_where_places_repeat(index, asked.question, options_for(answers.size()), asked.answer);
    if (tried == 0) note(asked, result.decision);
    if (asked.answer.verdict != relocalize::Verdict::closed) continue;
    ++tried;
    relocalize::Place place = asked.answer.places.front();
    for (relocalize::Pair& pair : place.pairs) pair.branch += offset;
    JoinedMaps joined = join_maps(filter, earlier.landmarks(), place, joint.ids, {}, lengths.pair_noise_m,
                                  options.search, LeftTwice::in_segments);
    note(joined.closing, result.decision);
    if (!joined.closing.accepted) continue;
    now_and_then();
    const SearchOptions across = across_sessions(options.search, lengths.pair_noise_m, place.pairs.size());
    auto factors = solve_together(earlier, session_map, joint.ids, options.search, across, joined);
    note(joined.closing, result.decision);
    result.T_component_session = core::compose(joined.filter.pose().mean, core::inverse(session_map.joint.pose));
    result.decision.T_map_session = result.T_component_session;
    component.factors = nullptr;
    take_in(session, joined, result, component);
    component.factors = std::move(factors);
    now = merged_by(joined);
    return true;
  }
  return false;
}

void call_as_now(const core::MergedIds& now, JoinedSession& session) {
  for (auto& [own, name] : session.name_of) name = now.now(name);
}

/// The session alone, without its immature landmarks.
core::JointMap begin(const core::JointMap& session, JoinedSession& result) {
  const EarlierMap mature(session);
  core::JointMap component = session;
  component.joint.ids = mature.landmarks().ids;
  component.joint.points_m = mature.landmarks().points_m;
  component.joint.covariance = mature.landmarks().covariance;
  component.states.assign(mature.landmarks().ids.size(), core::LandmarkState::mature);
  component.observations.clear();
  for (std::size_t i = 0; i < mature.landmarks().ids.size(); ++i) {
    component.observations.push_back(mature.observations(i));
    result.name_of[mature.landmarks().ids[i]] = mature.landmarks().ids[i];
  }
  tell_appearances(mature.appearance(), component);
  component.has_end = false;
  return component;
}

/// Those with the most mature landmarks first.
std::vector<std::size_t> largest_first(const std::vector<core::JointMap>& sessions) {
  const auto size = [&](std::size_t k) {
    const std::vector<core::LandmarkState>& states = sessions[k].states;
    return std::count(states.begin(), states.end(), core::LandmarkState::mature);
  };
  std::vector<std::size_t> order(sessions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto before = [&](std::size_t a, std::size_t b) {
    const Eigen::Vector3d pose_a = sessions[a].joint.pose.vector();
    const Eigen::Vector3d pose_b = sessions[b].joint.pose.vector();
    const auto key = [&](std::size_t k, const Eigen::Vector3d& pose) {
      return std::make_tuple(-size(k), pose.x(), pose.y(), pose.z());
    };
    return key(a, pose_a) < key(b, pose_b);
  };
  std::stable_sort(order.begin(), order.end(), before);
  return order;
}

}  // namespace

JoinedSessions join_sessions(const std::vector<core::JointMap>& sessions, const std::function<void()>& now_and_then) {
  JoinedSessions result;
  result.sessions.resize(sessions.size());
  std::vector<std::size_t> apart = largest_first(sessions);
  while (!apart.empty()) {
    const std::size_t number = result.components.size();
    result.sessions[apart.front()].component = number;
    core::JointMap component = begin(sessions[apart.front()], result.sessions[apart.front()]);
    std::vector<std::size_t> joined_there{apart.front()};
    apart.erase(apart.begin());
    for (std::size_t k = 0; k < apart.size();) {
      core::MergedIds now;
      if (!place_in(sessions[apart[k]], now_and_then, result.sessions[apart[k]], component, now)) {
        ++k;
        continue;
      }
      joined_there.push_back(apart[k]);
      for (const std::size_t one : joined_there) call_as_now(now, result.sessions[one]);
      result.sessions[apart[k]].component = number;
      apart.erase(apart.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;  // the others may fit what it added
    }
    result.components.push_back(std::move(component));
  }
  return result;
}

}  // namespace helixnav::supervisor
