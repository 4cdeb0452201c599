// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "common/plan.hpp"
#include "helixnav/files/number_text.hpp"
#include "team/team_folder.hpp"

namespace helixnav::apps {
namespace {

constexpr std::array<const char*, 8> colours{"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                             "#ff7f0e", "#8c564b", "#17becf", "#e377c2"};

/// Styled like the reports of the robots (reports/page/report.css). Lines and dots keep their width on any screen.
constexpr const char* style =
    ":root{color-scheme:light dark;--paper:#fff;--panel:#f6f7f9;--line:#d9dde3;--ink:#1b2330;--accent:#0b62a8}"
    "@media(prefers-color-scheme:dark){:root{--paper:#14181f;--panel:#1c222b;--line:#333c48;--ink:#e6eaf0;"
    "--accent:#6cb2ee}}"
    "body{margin:0 auto;max-width:1240px;padding:1.5rem;background:var(--paper);color:var(--ink);font:15px/1.5 "
    "system-ui,\"Liberation Sans\",sans-serif}"
    "a{color:var(--accent)}code{overflow-wrap:anywhere}"
    "pre{background:var(--panel);border:1px solid var(--line);padding:1rem;white-space:pre-wrap}"
    "polyline,path{vector-effect:non-scaling-stroke}.truth{stroke:var(--line);stroke-width:5}"
    ".landmark{stroke:var(--ink);stroke-width:5;stroke-linecap:round}";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

std::string shortened(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

/// A picture of one frame: x to the right, y up, metres.
class Picture {
 public:
  void polyline(const std::vector<Eigen::Vector2d>& points_m, const std::string& style) {
    if (points_m.empty()) return;
    body_ += "<polyline fill=\"none\" " + style + " points=\"";
    for (const Eigen::Vector2d& point_m : points_m) body_ += place(point_m) + ' ';
    body_ += "\"/>\n";
  }

  void dot(const Eigen::Vector2d& at_m, const std::string& title) {
    body_ += "<path class=\"landmark\" d=\"M" + place(at_m) + "h0\"><title>" + title + "</title></path>\n";
  }

  std::string html() const {
    return plan_html({low_.x(), -high_.y()}, {high_.x(), -low_.y()}, body_, "Paths and landmarks in this frame");
  }

 private:
  std::string place(const Eigen::Vector2d& point_m) {
    const Eigen::Vector2d on_page(point_m.x(), -point_m.y());
    low_ = empty_ ? on_page : Eigen::Vector2d(low_.cwiseMin(on_page));
    high_ = empty_ ? on_page : Eigen::Vector2d(high_.cwiseMax(on_page));
    empty_ = false;
    return shortened(on_page.x()) + ',' + shortened(on_page.y());
  }

  bool empty_ = true;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_ = Eigen::Vector2d::Zero();
  std::string body_;
};

std::string picture_of(const TeamTask& task, const TeamDrive& drive, int component) {
  Picture picture;
  const std::optional<core::Pose2> T = frame_of_truth(task, component);
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    if (drive.robots[r].component != component) continue;
    std::vector<Eigen::Vector2d> truth_m, then_m, now_m;
    core::Nanoseconds last_ns = 0;
    constexpr core::Nanoseconds every_ns = 200'000'000;
    for (const core::TruePose& pose : task.recording.robots[r].recording.true_poses) {
      if (!T || (!truth_m.empty() && pose.t_ns - last_ns < every_ns)) continue;
      truth_m.push_back(core::compose(*T, pose.T_world_robot).position_m());
      last_ns = pose.t_ns;
    }
    for (const core::StepReport& step : drive.robots[r].steps) then_m.push_back(step.pose.mean.position_m());
    for (const core::StampedPose& pose : drive.team.path(static_cast<int>(r))) {
      now_m.push_back(pose.T_world_robot.position_m());
    }
    const std::string stroke =
        std::string("stroke=\"") + colours[r % colours.size()] + "\" vector-effect=\"non-scaling-stroke\" ";
    picture.polyline(truth_m, "class=\"truth\"");
    picture.polyline(then_m, stroke + "stroke-width=\"0.7\" stroke-dasharray=\"3 2\"");
    picture.polyline(now_m, stroke + "stroke-width=\"1.3\"");
  }
  for (const core::MapLandmark& landmark : drive.team.map(component)) {
    picture.dot(landmark.point.mean_m, "landmark " + std::to_string(landmark.id) + ", " +
                                           std::to_string(landmark.observations) + " observations");
  }
  return picture.html();
}

std::string legend(const TeamTask& task, const TeamDrive& drive, int component) {
  std::string text = "<p>";
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    if (drive.robots[r].component != component) continue;
    const std::string number = std::to_string(task.recording.robots[r].number);
    text += std::string("<span style=\"color:") + colours[r % colours.size()] + "\">■</span> <a href=\"robot_" +
            number + "/report.html\">robot " + number + "</a> ";
  }
  return text + "</p>\n";
}

}  // namespace

std::string team_page(const std::string& command, const TeamTask& task, const TeamDrive& drive,
                      const TeamEvaluation& evaluation) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>HelixNav team</title>\n<style>" +
      std::string(style) + plan_style + "</style></head><body>\n<h1>" + escaped(task.recording.name) +
      "</h1>\n<p><code>" + escaped(command) + "</code></p>\n<pre>" + escaped(team_text(task, drive, evaluation)) +
      "</pre>\n";
  std::set<int> components;
  for (const TeamDrive::Robot& robot : drive.robots) components.insert(robot.component);
  for (const int component : components) {
    const int number = task.recording.robots[static_cast<std::size_t>(component)].number;
    page += "<h2>" + (task.unknown_starts ? "Frame of robot " + std::to_string(number) : "Common frame") + "</h2>\n";
    page += legend(task, drive, component) + picture_of(task, drive, component);
  }
  page +=
      "<p>Dashed: as estimated then. Solid: as known at the end. Grey: the truth, where there is one. Dots: "
      "landmarks.</p>\n</body></html>\n";
  return page;
}

}  // namespace helixnav::apps
