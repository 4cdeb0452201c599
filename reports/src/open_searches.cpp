// SPDX-License-Identifier: BSD-3-Clause
#include "open_searches.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include <Eigen/Cholesky>

#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/only_localized.hpp"

namespace helixnav::reports {
namespace {

struct OpenSearch {
  enum class End { none, undecided, new_ground };
  End end = End::none;
  std::size_t from = 0, to = 0;  ///< steps [from, to)
  bool is_lost = false;          ///< it began where everything in view had vanished
};

bool closed_in(const core::StepReport& step) {
  return std::any_of(step.decisions.begin(), step.decisions.end(), [](const core::Decision& decision) {
    const auto* closure = std::get_if<core::ClosureDecision>(&decision);
    return (closure != nullptr && closure->accepted) || core::begins_part(decision);
  });
}

bool begins_part_in(const core::StepReport& step) {
  return std::any_of(step.decisions.begin(), step.decisions.end(), core::begins_part);
}

bool lost_by_slip(const core::StepReport& step) {
  return std::any_of(step.decisions.begin(), step.decisions.end(), [](const core::Decision& decision) {
    return std::holds_alternative<core::LostBySlipDecision>(decision);
  });
}

/// [landmark] the step in which it began; those of an earlier map are not there.
using Begins = std::map<core::LandmarkId, std::size_t>;

void note_begun(const core::StepReport& step, std::size_t k, Begins& begins) {
  for (const core::AssociationReport& a : step.associations) {
    if (a.outcome == core::Outcome::augmented) begins.emplace(a.landmark, k);
  }
}

/// Most of what a closing merged was known before the search.
bool ties_to_before(const core::StepReport& step, const OpenSearch& search, const Begins& begins) {
  const auto known = std::count_if(step.merged.begin(), step.merged.end(), [&](const core::MergedLandmarks& one) {
    const auto begin = begins.find(one.kept);
    return begin == begins.end() || begin->second < search.from;
  });
  return 2 * known > static_cast<std::ptrdiff_t>(step.merged.size());
}

OpenSearch::End end_in(const core::StepReport& step) {
  for (const core::Decision& decision : step.decisions) {
    if (std::holds_alternative<core::UndecidedDecision>(decision)) return OpenSearch::End::undecided;
    if (std::holds_alternative<core::NewGroundDecision>(decision)) return OpenSearch::End::new_ground;
  }
  return OpenSearch::End::none;
}

/// As supervisor/slip/untied: as many landmarks as a place needs were known before and seen after it, and they are not few.
bool is_tied_again_after(const OpenSearch& search, const runs::Run& run, const Begins& begins) {
  std::set<core::LandmarkId> seen;
  for (std::size_t k = search.to; k < run.steps.size(); ++k) {
    for (const core::AssociationReport& a : run.steps[k].associations) {
      if (a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented) seen.insert(a.landmark);
    }
  }
  const auto known = std::count_if(seen.begin(), seen.end(), [&](core::LandmarkId id) {
    const auto begin = begins.find(id);
    return begin == begins.end() || begin->second < search.from;
  });
  constexpr std::ptrdiff_t least = 5, few = 3;
  return known >= least && few * known > static_cast<std::ptrdiff_t>(seen.size());
}

/// Those that no closing decided afterwards; the one open at the end is the last. Where the vehicle was lost, a closing of what was
/// mapped since then decides nothing.
std::vector<OpenSearch> open_searches(const runs::Run& run) {
  std::vector<OpenSearch> found;
  std::optional<OpenSearch> open;
  Begins begins;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const core::StepReport& step = run.steps[k];
    const OpenSearch::End end = end_in(step);
    note_begun(step, k, begins);
    if (step.mode == core::Mode::searching && (!open || lost_by_slip(step))) {
      open = OpenSearch{OpenSearch::End::none, k, k, lost_by_slip(step)};
    }
    if (closed_in(step)) {
      const auto is_decided = [&](const OpenSearch& search) {
        return !search.is_lost || begins_part_in(step) || ties_to_before(step, search, begins);
      };
      found.erase(std::remove_if(found.begin(), found.end(), is_decided), found.end());
    }
    if (open && end != OpenSearch::End::none) found.push_back({end, open->from, k + 1, open->is_lost});
    if (closed_in(step) || end != OpenSearch::End::none || step.mode == core::Mode::mapping) open.reset();
  }
  if (open) found.push_back({OpenSearch::End::none, open->from, run.steps.size(), open->is_lost});
  const auto is_over = [&](const OpenSearch& search) {
    return search.is_lost && is_tied_again_after(search, run, begins);
  };
  found.erase(std::remove_if(found.begin(), found.end(), is_over), found.end());
  for (OpenSearch& search : found) search.to = search.is_lost ? run.steps.size() : search.to;
  return found;
}

/// [landmark that lasted] the step in which it began.
std::map<core::LandmarkId, std::size_t> begins_of_lasting(const runs::Run& run) {
  std::map<core::LandmarkId, std::size_t> begins;
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state == core::LandmarkState::mature) begins.emplace(landmark.id, 0);
  }
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    for (const core::AssociationReport& a : run.steps[k].associations) {
      const auto found = begins.find(a.landmark);
      if (a.outcome == core::Outcome::augmented && found != begins.end()) found->second = k;
    }
  }
  return begins;
}

bool stand_alike(const core::PointGaussian& a, const core::PointGaussian& b) {
  constexpr double surely = 9.21;  // 99 % of two degrees of freedom
  const Eigen::Vector2d apart_m = a.mean_m - b.mean_m;
  const Eigen::Matrix2d S = a.covariance_m2 + b.covariance_m2;
  return apart_m.dot(S.ldlt().solve(apart_m)) < surely;
}

/// Of landmarks that lasted: those that began in a search, and of them those that stand where one does that is older.
struct Begun {
  std::size_t all = 0, on_old = 0;
};

Begun begun_in(const OpenSearch& search, const runs::Run& run) {
  const std::map<core::LandmarkId, std::size_t> begins = begins_of_lasting(run);
  std::vector<const core::MapLandmark*> old, fresh;
  for (const core::MapLandmark& landmark : run.map) {
    const auto begin = begins.find(landmark.id);
    if (begin == begins.end()) continue;
    if (begin->second < search.from) old.push_back(&landmark);
    if (begin->second >= search.from && begin->second < search.to) fresh.push_back(&landmark);
  }
  Begun begun{fresh.size(), 0};
  for (const auto* landmark : fresh) {
    begun.on_old += std::any_of(old.begin(), old.end(), [&](const core::MapLandmark* other) {
      return stand_alike(landmark->point, other->point);
    });
  }
  return begun;
}

double driven_in(const OpenSearch& search, const runs::Run& run) {
  double driven_m = 0.0;
  for (std::size_t k = search.from + 1; k < search.to; ++k) {
    driven_m += (run.steps[k].pose.mean.position_m() - run.steps[k - 1].pose.mean.position_m()).norm();
  }
  return driven_m;
}

std::string driven_text(const OpenSearch& search, const runs::Run& run) {
  return short_number(driven_in(search, run)) + " m, from " + short_number(core::seconds(run.steps[search.from].t_ns)) +
         " s on";
}

/// "12 landmarks mapped since may be on the map twice, 8 of them stand where old ones do".
std::string twice_text(const Begun& begun, const std::string& when) {
  const std::string twice =
      counted(static_cast<double>(begun.all), "landmark") + " mapped " + when + " may be on the map twice";
  return begun.on_old == 0 ? twice : twice + ", " + std::to_string(begun.on_old) + " of them stand where old ones do";
}

std::string text_of(const OpenSearch& search, const Begun& begun, const runs::Run& run) {
  const std::string since = driven_text(search, run);
  const std::string advice =
      ". Driving over more of the old ground would decide it; 'helixnav explain RUN' has the numbers, and 'helixnav "
      "calibrate' estimates the noise and constants that make returns ambiguous where they are wrong";
  switch (search.end) {
    case OpenSearch::End::none:
      return "a search was still open at the end (" + since + "): it is undecided whether this is old ground, and " +
             twice_text(begun, "since") + advice;
    case OpenSearch::End::undecided:
      return "a search ended undecided (" + since + ") and no loop was closed after it: " + twice_text(begun, "in it") +
             advice;
    case OpenSearch::End::new_ground:
      return "a search ended as on new ground (" + since + "), which is doubtful: " + twice_text(begun, "in it") +
             advice;
  }
  return {};
}

std::string lost_text(const OpenSearch& search, const runs::Run& run) {
  return "everything in view vanished at " + short_number(core::seconds(run.steps[search.from].t_ns)) +
         " s, as when a vehicle is carried, and where it is on what was mapped before was not decided since: its pose "
         "from then on may be anywhere there, and " +
         twice_text(begun_in(search, run), "since") + "; 'helixnav explain RUN' has the numbers";
}

/// It began because the pose had turned out to be wrong, not because it was about to become ambiguous.
bool began_lost(const core::StepReport& step) {
  return std::any_of(step.decisions.begin(), step.decisions.end(), [](const core::Decision& decision) {
    return std::holds_alternative<core::RollbackDecision>(decision) ||
           std::holds_alternative<core::LostBySlipDecision>(decision);
  });
}

/// Empty unless the last one is open at the end, and began with a wrong pose or has been open for longer than it takes to begin one.
std::string still_open_text(const std::vector<OpenSearch>& searches, const runs::Run& run) {
  constexpr std::size_t long_open = 20;  // scans
  if (searches.empty() || searches.back().end != OpenSearch::End::none) return {};
  const OpenSearch& last = searches.back();
  if (last.to - last.from < long_open && !began_lost(run.steps[last.from])) return {};
  return "a search was still open at the end (" + driven_text(last, run) +
         "): where the vehicle is on what was mapped before is undecided, and its pose since may be wrong by more than "
         "its covariance says; 'helixnav explain RUN' has the numbers";
}

}  // namespace

std::string open_search_text(const runs::Run& run) {
  const std::vector<OpenSearch> searches = open_searches(run);
  if (runs::only_localized(run)) return still_open_text(searches, run);
  const auto lost = std::find_if(searches.begin(), searches.end(), [](const OpenSearch& s) { return s.is_lost; });
  if (lost != searches.end() && lost->end == OpenSearch::End::undecided) return lost_text(*lost, run);
  constexpr std::size_t several = 3;
  for (auto search = searches.rbegin(); search != searches.rend(); ++search) {
    const Begun begun = begun_in(*search, run);
    // New ground has none at all; of the honest drives that took old ground for new one had 18 of 49.
    const std::size_t doubtful = search->end == OpenSearch::End::new_ground ? begun.on_old : begun.all;
    if (doubtful >= several) return text_of(*search, begun, run);
  }
  return still_open_text(searches, run);
}

}  // namespace helixnav::reports
