// SPDX-License-Identifier: BSD-3-Clause
#include "campaign_run.hpp"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "campaign.hpp"
#include "common/chosen_navigator.hpp"
#include "common/interrupt.hpp"
#include "common/timed.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/evaluation/referee.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::apps {
namespace {

using Json = nlohmann::ordered_json;
double degrees(double angle_rad) { return angle_rad * 180.0 / core::pi; }

struct WallClock {
  double run_s = 0.0;
  double search_s = 0.0;   ///< of the scans while a question was open
  double closing_s = 0.0;  ///< of the scans that closed, or tried to
};

const char* word_of(evaluation::RunVerdict verdict) {
  switch (verdict) {
    case evaluation::RunVerdict::closed:
      return "closed";
    case evaluation::RunVerdict::false_closure:
      return "false";
    case evaluation::RunVerdict::undecided:
      return "undecided";
  }
  return "";
}

Json json_of(const evaluation::JudgedPose& pose) {
  return {{"position_error_m", pose.relative.position_m},
          {"heading_error_deg", degrees(pose.relative.heading_rad)},
          {"absolute_position_error_m", pose.absolute.position_m},
          {"absolute_heading_error_deg", degrees(pose.absolute.heading_rad)},
          {"nees", pose.nees}};
}

Json json_of(const evaluation::ClosureScore& closure) {
  Json json = {{"step", closure.step},
               {"false", closure.is_false},
               {"pairs", closure.pairs},
               {"wrong_pairs", closure.wrong_pairs},
               {"after_reentry_m", closure.after_reentry_m},
               {"rival_share", closure.rival_share}};
  json.update(json_of(closure.pose));
  return json;
}

Json json_of(const evaluation::ReturnScore& one) {
  Json json = {{"closed", one.closed},
               {"reentry_step", one.reentry_step},
               {"error_before_m", one.error_before_m},
               {"old_matches", one.old_matches},
               {"wrong_old_matches", one.wrong_old_matches}};
  json.update(json_of(one.end_on_old_ground));
  json["associated_position_error_m"] = one.associated.relative.position_m;
  return json;
}

template <typename Item>
Json list_of(const std::vector<Item>& items) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

Json json_of(const evaluation::RunScore& score) {
  return {{"verdict", word_of(score.verdict)},
          {"diverged_after_closure", score.diverged_after_closure},
          {"closed_by_association", score.closed_by_association},
          {"returns", list_of(score.returns)},
          {"closures", list_of(score.closures)},
          {"triggers", score.triggers},
          {"rolled_back", score.rolled_back},
          {"refused", score.refused},
          {"left_open", score.undecided},
          {"new_ground", score.new_ground},
          {"new_ground_wrong", score.new_ground_wrong},
          {"old_matches", score.old_matches},
          {"wrong_old_matches", score.wrong_old_matches},
          {"wrong_before_trigger", score.wrong_before_trigger},
          {"wrong_without_trigger", score.wrong_without_trigger},
          {"slips", score.slips},
          {"slips_decided", score.slips_decided},
          {"slips_unfounded", score.slips_unfounded},
          {"spacing_m", score.spacing_m},
          {"end", json_of(score.end)},
          {"end_on_old_ground", json_of(score.end_on_old_ground)},
          {"trees_seen", score.trees_seen},
          {"mature_landmarks", score.mature_landmarks},
          {"duplicates", score.duplicates},
          {"not_trees", score.not_trees},
          {"map_rms_m", score.map_rms_m}};
}

bool has_closure(const core::StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), core::is_closure);
}

evaluation::RunScore drive_and_judge(const Campaign& campaign, std::uint64_t seed, WallClock& wall) {
  const sim::World world = sim::build_world(campaign.scenario.world, seed);
  const core::Recording recording = sim::simulate_in(world, campaign.scenario, seed);
  ChosenNavigator navigator(recording, campaign.navigator, campaign.known_association);
  evaluation::Referee referee(recording, world.returns_at_m);
  Timed timed(navigator);
  core::EventLoop loop(recording.events, timed);
  while (!interrupt_pending()) {
    const std::optional<core::StepReport> report = loop.next();
    if (!report) break;
    const double seconds = timed.last_s();
    wall.run_s += seconds;
    if (report->mode == core::Mode::searching) wall.search_s += seconds;
    if (has_closure(*report)) wall.closing_s += seconds;
    referee.watch(*report, [&navigator] { return navigator.sketch(); });
  }
  return referee.score(navigator.map());
}

}  // namespace

std::string run_and_judge(const Campaign& campaign, std::uint64_t seed) {
  WallClock wall;
  Json row = {{"seed", seed}};
  try {
    row.update(json_of(drive_and_judge(campaign, seed, wall)));
  } catch (const core::NumericalError& error) {
    row["verdict"] = "failed";
    row["error"] = error.what();
  }
  if (interrupt_pending()) return {};
  row["wall"] = {{"run_s", wall.run_s}, {"search_s", wall.search_s}, {"closing_s", wall.closing_s}};
  return row.dump();
}

}  // namespace helixnav::apps
