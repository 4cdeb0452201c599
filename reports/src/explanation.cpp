// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/explanation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/runs/only_localized.hpp"
#include "known_by_name.hpp"
#include "numerics_text.hpp"
#include "place_questions.hpp"
#include "slip_spans.hpp"

namespace helixnav::reports {
namespace {

struct Decided {
  const core::StepReport* step;
  const core::Decision* decision;
};

std::vector<Decided> decisions_of(const runs::Run& run) {
  std::vector<Decided> decided;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) decided.push_back({&step, &decision});
  }
  return decided;
}

bool is_closure(const Decided& decided) { return core::is_closure(*decided.decision); }
bool is_trigger(const Decided& decided) { return core::is_trigger(*decided.decision); }

std::string verdict_of(const Decided& decided) { return core::row_of(*decided.decision).verdict; }

std::string when(const core::StepReport& step) {
  return "step " + std::to_string(step.step) + " (" + short_number(core::seconds(step.t_ns)) + " s)";
}

std::string line_of(const Decided& decided) {
  return "  " + when(*decided.step) + "  " + sentence_of(*decided.decision) + '\n';
}

std::ptrdiff_t count_of(const std::vector<Decided>& closures, const char* verdict) {
  return std::count_if(closures.begin(), closures.end(),
                       [&](const Decided& closure) { return verdict_of(closure) == verdict; });
}

std::string merges_of(const core::StepReport& step) {
  std::string text;
  for (const core::MergedLandmarks& merge : step.merged) {
    if (merge.kept == merge.removed) continue;
    if (text.empty()) text = "  Merged:";
    text += ' ' + std::to_string(merge.removed) + " into " + std::to_string(merge.kept) + ',';
  }
  if (text.empty()) return text;
  text.back() = '.';
  return text + '\n';
}

std::string margin_of(const core::AssociationReport& a) {
  if (std::isinf(a.margin_nats)) return "there is no other explanation";
  return "the best other explanation costs " + short_number(a.margin_nats) + " nats more";
}

/// The same after what was chosen; empty where nobody asked.
std::string rival_of(const core::AssociationReport& a) {
  return std::isnan(a.margin_nats) ? std::string() : "; " + margin_of(a);
}

std::string nis_of(const core::AssociationReport& a) {
  return "NIS " + short_number(a.nis) + " with " + std::to_string(a.dof) + " degrees of freedom";
}

std::string landmark_of(const runs::Run& run, core::LandmarkId id) {
  const auto name = run.names.find(id);
  return "landmark " + std::to_string(id) + (name == run.names.end() ? "" : " ('" + name->second + "')");
}

/// Of landmarks that are known by name, where it is not as of others.
std::string fate_by_name(const core::AssociationReport& a, const std::string& landmark) {
  if (a.outcome == core::Outcome::augmented) return "began " + landmark + ": its name was new.";
  if (a.outcome == core::Outcome::ambiguous && a.dof == 0) {
    return "waits: its landmark has not been seen from places far enough apart to be located.";
  }
  return {};
}

std::string fate_of(const core::AssociationReport& a, const runs::Run& run) {
  const std::string landmark = landmark_of(run, a.landmark);
  const std::string by_name = known_by_name(run) ? fate_by_name(a, landmark) : std::string();
  if (!by_name.empty()) return by_name;
  const bool has_pair = a.dof > 0 && !std::isnan(a.nis);
  switch (a.outcome) {
    case core::Outcome::matched:
      return "updated " + landmark + ": " + (has_pair ? nis_of(a) + rival_of(a) : "known by name") + '.';
    case core::Outcome::augmented:
      return "began " + landmark + ": it is outside the gates of all landmarks.";
    case core::Outcome::rejected:
      if (!has_pair) return "was dropped: it is labelled as no landmark, or as one that this scan has already seen.";
      return "was dropped from " + landmark + " (" + nis_of(a) +
             "): it failed the joint test with the other pairs of the scan.";
    case core::Outcome::ambiguous:
      if (!has_pair) return "was dropped: too far from every landmark to be matched, too near one to be new.";
      return "was dropped: " + landmark + " is the nearest (" + nis_of(a) +
             "), but too far to be matched or not clearly enough (" + margin_of(a) +
             "), and too near to begin a new one.";
  }
  return {};
}

const core::StepReport& step_numbered(const runs::Run& run, std::int64_t step) {
  const auto found = std::find_if(run.steps.begin(), run.steps.end(),
                                  [&](const core::StepReport& report) { return report.step == step; });
  if (found != run.steps.end()) return *found;
  const std::string steps =
      run.steps.empty() ? "none"
                        : std::to_string(run.steps.front().step) + " to " + std::to_string(run.steps.back().step);
  throw core::InputError(run.path + ": no step " + std::to_string(step) + "; this run has " + steps);
}

/// Where the constellation alone did not find the place that was closed: what did, and what became of the odometry.
std::string found_by(const Decided& closure) {
  if (closure.decision == &closure.step->decisions.front()) return {};
  const core::Decision& before = *(closure.decision - 1);
  const bool is_found_by = std::holds_alternative<core::WholeMapDecision>(before) ||  //
                           std::holds_alternative<core::ShapeDecision>(before);
  return is_found_by ? sentence_of(before) + ' ' : std::string();
}

/// A search, or what mapping had come to, was over: with the map closed, or left open.
bool ends_search(const Decided& decided) { return is_closure(decided) && verdict_of(decided) != "refused"; }

bool is_carried(const Decided& decided) { return std::holds_alternative<core::CarriedDecision>(*decided.decision); }
bool is_placing(const Decided& decided) {
  return is_carried(decided) || std::holds_alternative<core::PlacedDecision>(*decided.decision);
}

/// Whether a session found its place on an earlier map, where it looked for one: answers that say something else than the one
/// before, and what all of them came to.
std::string places_of(const runs::Run& run, const std::vector<Decided>& decided) {
  std::string text;
  bool accepted = false, carried = false;
  std::map<int, std::string> last;  // [part] verdict
  for (const Decided& one : decided) {
    if (!is_placing(one)) continue;
    const auto* placed = std::get_if<core::PlacedDecision>(one.decision);
    if (placed == nullptr) last.clear();  // each part looks for its place anew
    if (placed == nullptr || std::exchange(last[placed->part], verdict_of(one)) != verdict_of(one))
      text += line_of(one);
    accepted = placed != nullptr && (accepted || verdict_of(one) == "accepted");
    carried = carried || placed == nullptr;
  }
  if (text.empty()) return {};
  const char* const alone =
      runs::only_localized(run)
          ? "  It did not find its place: none of its poses is on the map, which stays as given.\n"
      : carried ? "  It has not found its place since: the map covers the last part only.\n"
                : "  It never found its place: the map covers this session only.\n";
  return std::string(carried ? "\nWhere the vehicle is:\n" : "\nThe earlier map:\n") + text +
         (accepted ? "" : alone + questions_text(questions_in(run))) + '\n';
}

/// Decisions of one kind, that need no search: the first few, and how many there are.
template <class Kind>
std::string all_of_kind(const std::vector<Decided>& decided, const char* heading) {
  constexpr int most = 5;
  int count = 0;
  std::string text;
  for (const Decided& one : decided) {
    if (std::holds_alternative<Kind>(*one.decision) && count++ < most) text += line_of(one);
  }
  if (count == 0) return {};
  const std::string more = count > most ? "  And " + std::to_string(count - most) + " more in decisions.csv.\n" : "";
  return '\n' + std::string(heading) + ", " + std::to_string(count) + ":\n" + text + more;
}

/// What became of all that was observed.
std::string fates_line(const runs::Run& run) {
  std::array<std::int64_t, 4> count{};  // [outcome]
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) ++count.at(static_cast<std::size_t>(a.outcome));
  }
  const auto of = [&](core::Outcome outcome) { return std::to_string(count.at(static_cast<std::size_t>(outcome))); };
  return "Observations: " + of(core::Outcome::matched) + " matched, " + of(core::Outcome::augmented) +
         " began landmarks, " + of(core::Outcome::ambiguous) + " ambiguous and left out, " +
         of(core::Outcome::rejected) + " rejected.\n";
}

bool has_observations(const runs::Run& run) {
  return std::any_of(run.steps.begin(), run.steps.end(),
                     [](const core::StepReport& step) { return !step.associations.empty(); });
}

bool is_of_search(const Decided& decided) {
  return is_closure(decided) || is_trigger(decided) ||
         std::holds_alternative<core::WholeMapDecision>(*decided.decision);
}

/// Said of every run, so that nobody need ask whether it was looked at.
std::string numerics_line(const runs::Run& run) {
  const core::NumericalHealth numerics = numerics_of(run);
  std::string text = numerics_text(numerics);
  if (text.empty()) {
    text = "nothing was repaired or refused; the least pivot of an innovation covariance was " +
           short_number(numerics.least_pivot);
  }
  const std::string postponed = postponed_text(postponed_in(run));
  return "\nNumerics: " + text + ".\n" + (postponed.empty() ? "" : "Budgets: " + postponed + ".\n");
}

}  // namespace

std::string explain_run(const runs::Run& run) {
  if (run.steps.empty()) return "0 steps: " + nothing_mapped_text(run) + ".\n";
  const std::vector<Decided> decided = decisions_of(run);
  std::vector<Decided> closures;
  std::copy_if(decided.begin(), decided.end(), std::back_inserter(closures), is_closure);
  if (run.steps.back().particles) {
    return std::to_string(run.steps.size()) +
           " steps of a cloud of particles, each of which associates for itself: there are no closings to explain. "
           "--step N shows what the heaviest one made of a scan.\n";
  }
  std::string text = std::to_string(run.steps.size()) +
                     " steps; closings: " + std::to_string(count_of(closures, "accepted")) + " accepted, " +
                     std::to_string(count_of(closures, "refused")) + " refused, " +
                     std::to_string(count_of(closures, "new-ground")) + " on new ground, " +
                     std::to_string(count_of(closures, "undecided")) + " left undecided.\n";
  text += fates_line(run) + places_of(run, decided);
  if (runs::only_localized(run)) {
    text += "The map stays as it was given: what fits none of its landmarks is rejected.\n";
  } else if (has_observations(run) && std::none_of(decided.begin(), decided.end(), is_of_search)) {
    text += "No return was ambiguous enough for a search: every scan was associated at once.\n";
  }
  for (std::size_t i = 0; i < closures.size(); ++i) {
    text += "\nClosure " + std::to_string(i + 1) + ", " + when(*closures[i].step) + ". " + found_by(closures[i]) +
            sentence_of(*closures[i].decision) + '\n';
  }
  if (run.steps.back().mode == core::Mode::searching) {
    text += "\nAt the end of the run a search was still open.\n";
  }
  for (const std::string& warning : {nothing_mapped_text(run), contradicted_place_text(run)}) {
    if (!warning.empty()) text += "\nWarning: " + warning + ".\n";
  }
  text += slips_text(run);
  text += all_of_kind<core::MovingDecision>(decided, "What moves");
  text += all_of_kind<core::SystematicDecision>(decided, "Constant errors");
  text += all_of_kind<core::NoiseDecision>(decided, "Noise that was learnt");
  text += numerics_line(run);
  if (!closures.empty()) text += "\nDetails of one: helixnav explain " + run.path + " --closure 1\n";
  return text;
}

std::string explain_closure(const runs::Run& run, std::size_t closure) {
  const std::vector<Decided> decided = decisions_of(run);
  std::size_t found = 0;
  auto last = decided.begin();
  for (; last != decided.end(); ++last) {
    if (is_closure(*last) && ++found == closure) break;
  }
  if (last == decided.end()) {
    throw core::InputError(run.path + ": no closure " + std::to_string(closure) + "; this run has " +
                           std::to_string(found));
  }
  auto first = last;
  while (first != decided.begin() && !is_trigger(*first) && !ends_search(*(first - 1))) --first;
  std::string text = "Closure " + std::to_string(closure) + " of this run: " + verdict_of(*last) + ".\n";
  for (auto it = first; it != last + 1; ++it) text += line_of(*it);
  text += merges_of(*last->step);
  const auto next = last + 1;
  return next != decided.end() && std::holds_alternative<core::SmoothingDecision>(*next->decision)
             ? text + line_of(*next)
             : text;
}

std::string explain_step(const runs::Run& run, std::int64_t step) {
  const core::StepReport& report = step_numbered(run, step);
  const Eigen::Matrix3d& P = report.pose.covariance;
  std::string text = when(report) + ", " + (report.mode == core::Mode::searching ? "searching" : "mapping") +
                     ": the pose is (" + short_number(report.pose.mean.x_m) + ", " +
                     short_number(report.pose.mean.y_m) + ") m, uncertain by " +
                     short_number(std::sqrt(P(0, 0) + P(1, 1))) + " m.\n";
  text.front() = 'S';
  if (report.mode == core::Mode::searching) text += "  Old landmarks are excluded while the search lasts.\n";
  if (report.associations.empty()) text += "  Nothing was observed.\n";
  for (const core::AssociationReport& a : report.associations) {
    text += "  Observation " + std::to_string(a.observation) + ' ' + fate_of(a, run) + '\n';
  }
  for (const core::Decision& decision : report.decisions) text += "  " + sentence_of(decision) + '\n';
  const std::string numerics = numerics_text(report.numerics);
  if (!numerics.empty()) text += "  In this step: " + numerics + ".\n";
  return text + merges_of(report);
}

}  // namespace helixnav::reports
