// SPDX-License-Identifier: BSD-3-Clause
#include "joined_page.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "common/plan.hpp"
#include "helixnav/core/decision_row.hpp"
#include "joined_warnings.hpp"

namespace helixnav::apps {
namespace {

constexpr const char* page_style = R"(
:root{color-scheme:light dark;--paper:#fff;--ink:#1b2330;--quiet:#5d6878;--line:#d9dde3;--kept:#8a94a3;--gone:#b3261e;--new:#1a7f4b;--moved:#6b46c1;--both:#b35900}
@media(prefers-color-scheme:dark){:root{--paper:#12161c;--ink:#e6e9ee;--quiet:#9aa5b4;--line:#313a46;--kept:#6d7887;--gone:#ff8a80;--new:#5fd39a;--moved:#b79cff;--both:#ffb066}}
body{font:15px/1.45 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;background:var(--paper);color:var(--ink)}
.scroll{overflow-x:auto}table{border-collapse:collapse}td,th{padding:.2em .8em .2em 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}
.quiet{color:var(--quiet)}.warning{border-left:.25em solid var(--gone);padding-left:.8em}.key{display:inline-block;margin-right:1.4em}.key svg{width:1.1em;height:1.1em;border:0;vertical-align:-.15em;margin-right:.3em}
svg *{vector-effect:non-scaling-stroke}.alone{fill:none;stroke:var(--kept);stroke-width:1}.kept{fill:var(--kept)}
.gone{fill:none;stroke:var(--gone);stroke-width:2}.new{fill:none;stroke:var(--new);stroke-width:2}.moved{fill:none;stroke:var(--moved);stroke-width:2}.both{fill:none;stroke:var(--both);stroke-width:2}
)";

std::string as_html(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

std::string metres_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

/// Attributes x1 y1 x2 y2 of a line; y goes up.
std::string path_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return "M" + metres_text(from.x()) + ' ' + metres_text(-from.y()) + 'L' + metres_text(to.x()) + ' ' +
         metres_text(-to.y());
}

/// A mark of the given half width: shapes differ, so that colour alone carries no information.
std::string change_mark(const std::string& kind, const Eigen::Vector2d& at, double r, const std::string& title) {
  const std::string tip = "<title>" + as_html(title) + "</title>";
  const std::string centre = "cx=\"" + metres_text(at.x()) + "\" cy=\"" + metres_text(-at.y()) + "\" r=\"";
  if (kind == "kept" || kind == "alone") {
    return "<circle class=\"" + kind + "\" " + centre + metres_text(0.45 * r) + "\">" + tip + "</circle>\n";
  }
  const Eigen::Vector2d across(r, r), down(r, -r), right(r, 0.0), up(0.0, r);
  std::string path = path_line(at - right, at + right) + path_line(at - up, at + up);  // new: a plus
  if (kind == "gone") path = path_line(at - across, at + across) + path_line(at - down, at + down);
  if (kind == "both")
    path = path_line(at - across, at + down) + path_line(at + down, at + up) + path_line(at + up, at - across);
  return "<path class=\"" + kind + "\" d=\"" + path + "\">" + tip + "</path>\n";
}

/// A diamond at the current place, with a line from the old one: a move is often shorter than a mark is wide.
std::string moved_mark(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double r, const std::string& title) {
  const Eigen::Vector2d right(r, 0.0), up(0.0, r);
  const std::string path = path_line(from, to) + path_line(to - right, to + up) + path_line(to + up, to + right) +
                           path_line(to + right, to - up) + path_line(to - up, to - right);
  return "<path class=\"moved\" d=\"" + path + "\"><title>" + as_html(title) + "</title></path>\n";
}

std::string sessions_text(const std::vector<std::size_t>& sessions, const std::vector<std::string>& names) {
  std::string text;
  for (const std::size_t k : sessions) text += (text.empty() ? "" : ", ") + names[k];
  return text;
}

std::string title_of(const ChangedLandmark& landmark, const std::vector<std::string>& names) {
  std::string text = "landmark " + std::to_string(landmark.id) + ": " + name_of(landmark.change());
  text += "; seen in " + sessions_text(landmark.seen_in, names);
  if (!landmark.missing_in.empty()) text += "; not in " + sessions_text(landmark.missing_in, names);
  return text;
}

/// One component from above.
std::string component_picture(std::size_t component, const core::JointMap& map,
                              const std::vector<ChangedLandmark>& shared, const std::vector<std::string>& names) {
  Eigen::Vector2d low = map.joint.points_m.front(), high = low;
  for (const Eigen::Vector2d& point_m : map.joint.points_m) low = low.cwiseMin(point_m), high = high.cwiseMax(point_m);
  const double wide = std::max({(high - low).maxCoeff(), 1.0});
  const double r = 0.008 * wide;
  std::map<core::LandmarkId, const ChangedLandmark*> changed;
  for (const ChangedLandmark& landmark : shared) {
    if (landmark.component == component) changed[landmark.id] = &landmark;
  }
  std::string quiet, loud;  // changes are drawn over what did not change
  for (std::size_t i = 0; i < map.joint.ids.size(); ++i) {
    const auto at = changed.find(map.joint.ids[i]);
    if (at == changed.end()) {
      quiet += change_mark("alone", map.joint.points_m[i], r,
                           "landmark " + std::to_string(map.joint.ids[i]) + ": one session looked there");
      continue;
    }
    const ChangedLandmark& landmark = *at->second;
    const std::string title = title_of(landmark, names);
    if (landmark.change() != Change::moved) {
      std::string& layer = landmark.change() == Change::kept ? quiet : loud;
      layer += change_mark(name_of(landmark.change()), landmark.point_m, r, title);
    } else if (landmark.is_gone()) {
      loud += moved_mark(landmark.point_m, changed.at(landmark.counterpart)->point_m, r, title);
    }
  }
  return plan_html(low, high, quiet + loud, "Map of component " + std::to_string(component + 1));
}

std::string counts_of(std::size_t component, const std::vector<ChangedLandmark>& shared) {
  std::map<Change, int> counts;
  for (const ChangedLandmark& landmark : shared) counts[landmark.change()] += landmark.component == component ? 1 : 0;
  counts[Change::moved] /= 2;
  const auto key = [](const std::string& drawing, const std::string& text) {
    return "<span class=\"key\"><svg viewBox=\"-1 -1 2 2\" aria-hidden=\"true\">" + drawing + "</svg>" + text +
           "</span>\n";
  };
  const Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  std::string text = "<p>";
  const auto count = [&](Change change, const std::string& drawing) {
    text += key(drawing, std::to_string(counts[change]) + ' ' + name_of(change));
  };
  count(Change::kept, change_mark("kept", middle, 0.9, "kept"));
  count(Change::gone, change_mark("gone", middle, 0.8, "gone"));
  count(Change::appeared, change_mark("new", middle, 0.8, "new"));
  count(Change::moved, moved_mark({-0.9, -0.9}, {0.2, 0.2}, 0.7, "moved"));
  count(Change::both, change_mark("both", middle, 0.8, "both"));
  return text + key(change_mark("alone", middle, 0.9, "one session"), "one session looked there") + "</p>\n";
}

std::string placing_table(const std::vector<std::string>& names, const supervisor::JoinedSessions& joined) {
  std::string text =
      "<div class=\"scroll\"><table><tr><th>session</th><th>component</th><th>placed</th><th>x</th><th>y</th>"
      "<th>heading</th><th>landmarks</th><th>merged</th><th>ahead / needed</th></tr>\n";
  for (std::size_t k = 0; k < names.size(); ++k) {
    const supervisor::JoinedSession& session = joined.sessions[k];
    const core::Pose2& T = session.T_component_session;
    const bool accepted = session.decision.verdict == core::PlacedDecision::Verdict::accepted;
    const std::string verdict =
        session.decision.questions == 0 ? "gives the frame" : core::row_of(session.decision).verdict;
    char numbers[160];
    std::snprintf(numbers, sizeof numbers,
                  "<td>%.2f m</td><td>%.2f m</td><td>%.2f°</td><td>%zu</td><td>%d</td><td>%s</td>", T.x_m, T.y_m,
                  T.heading_rad * 180.0 / core::pi, session.name_of.size(), session.decision.merged, "");
    std::string row(numbers);
    if (accepted) {
      char lead[64];
      std::snprintf(lead, sizeof lead, "<td>%.1f / %.1f nats</td>", session.decision.lead, session.decision.needed);
      row.replace(row.rfind("<td></td>"), 9, lead);
    }
    text += "<tr><td>" + as_html(names[k]) + "</td><td>" + std::to_string(session.component + 1) + "</td><td>" +
            verdict + "</td>" + row + "</tr>\n";
  }
  return text + "</table></div>\n";
}

}  // namespace

std::string joined_page(const std::vector<std::string>& names, const supervisor::JoinedSessions& joined,
                        const std::vector<ChangedLandmark>& shared) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>HelixNav joined sessions</title>\n<style>" +
      std::string(page_style) + plan_style + "</style></head><body>\n<h1>" + std::to_string(names.size()) +
      " sessions, " + std::to_string(joined.components.size()) +
      (joined.components.size() == 1 ? " map</h1>\n" : " maps that nothing joins</h1>\n") +
      placing_table(names, joined);
  for (const std::string& warning : joined_warnings(joined, shared)) {
    page += "<p class=\"warning\">⚠ " + as_html(warning) + "</p>\n";
  }
  for (std::size_t k = 0; k < joined.components.size(); ++k) {
    const core::JointMap& map = joined.components[k];
    page +=
        "<h2>Component " + std::to_string(k + 1) + ": " + std::to_string(map.joint.ids.size()) + " landmarks</h2>\n";
    if (map.joint.ids.empty()) continue;
    page += counts_of(k, shared) + component_picture(k, map, shared, names);
  }
  return page +
         "<p class=\"quiet\">Of the ground that several sessions looked at; a mark under the pointer says which saw "
         "it. Gone: "
         "in no later session that looked there, tentative in the map from here on. Moved: gone here and new near by, "
         "nearer "
         "than chance would have it. The tables are joins.csv and changes.csv.</p>\n</body></html>\n";
}

}  // namespace helixnav::apps
