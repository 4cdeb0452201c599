// SPDX-License-Identifier: BSD-3-Clause
#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace helixnav::apps {

/// Texts stand beside the drawing, not in it, so that they keep their size on any screen.
const char* const plan_style =
    ".plan{position:relative;margin:.6rem auto 3rem 4.2rem;max-width:calc(100% - 4.2rem)}"
    ".plan svg{position:absolute;width:100%;height:100%;max-height:none;border:1px solid "
    "var(--line);box-sizing:border-box}"
    ".plan .grid{fill:none;stroke:var(--line);stroke-width:1;vector-effect:non-scaling-stroke}"
    ".plan span{position:absolute;font-size:.8rem;line-height:1;white-space:nowrap;color:var(--ink)}"
    ".plan .x{top:calc(100% + .4rem);transform:translateX(-50%)}"
    ".plan .y{right:calc(100% + .4rem);transform:translateY(-50%)}"
    ".plan .x.axis{left:50%;top:calc(100% + 1.7rem)}"
    ".plan .y.axis{right:calc(100% + 2.6rem);top:50%;transform:translate(50%,-50%) rotate(-90deg)}";

namespace {

struct PlanFrame {
  Eigen::Vector2d low_m, size_m;
};

/// With a margin, and no side shorter than a quarter of the other: ticks need room.
PlanFrame plan_frame(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m) {
  const double longest_m = std::max((high_m - low_m).maxCoeff(), 1.0);
  const Eigen::Vector2d size_m = ((high_m - low_m).array() + 0.08 * longest_m).max(0.25 * longest_m).matrix();
  return {0.5 * (low_m + high_m - size_m), size_m};
}

/// 1, 2 or 5 times a power of ten, of which at most seven fit.
double tick_spacing_m(double longest_m) {
  constexpr double most = 7.0;
  const double least_m = longest_m / most;
  const double power = std::pow(10.0, std::floor(std::log10(least_m)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least_m) return digit * power;
  }
  return 10.0 * power;
}

template <class... Values>
std::string plan_text(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// With a minus sign, not a hyphen.
std::string tick_text(double value_m) { return (value_m < 0.0 ? "\u2212" : "") + plan_text("%.6g", std::abs(value_m)); }

struct PlanTicks {
  std::string grid, texts;
};

PlanTicks ticks_of(const PlanFrame& frame) {
  PlanTicks ticks;
  const double every_m = tick_spacing_m(frame.size_m.maxCoeff());
  const Eigen::Vector2d high_m = frame.low_m + frame.size_m;
  for (const int axis : {0, 1}) {
    const double first = std::ceil(frame.low_m[axis] / every_m), last = std::floor(high_m[axis] / every_m);
    for (double k = first; k <= last; ++k) {
      const double at_m = k * every_m + 0.0;  // no negative zero
      const double share = 100.0 * (at_m - frame.low_m[axis]) / frame.size_m[axis];
      if (axis == 0) {
        ticks.grid += plan_text("M%.3f %.3fV%.3f", at_m, -high_m.y(), -frame.low_m.y());
        ticks.texts += plan_text("<span class=\"x\" style=\"left:%.3f%%\">", share);
      } else {
        ticks.grid += plan_text("M%.3f %.3fH%.3f", frame.low_m.x(), -at_m, high_m.x());
        ticks.texts += plan_text("<span class=\"y\" style=\"top:%.3f%%\">", 100.0 - share);
      }
      ticks.texts += tick_text(at_m) + "</span>";
    }
  }
  return ticks;
}

}  // namespace

std::string plan_html(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, const std::string& body,
                      const std::string& label) {
  const PlanFrame frame = plan_frame(low_m, high_m);
  const PlanTicks ticks = ticks_of(frame);
  const double width = frame.size_m.x(), height = frame.size_m.y();
  return plan_text("<div class=\"plan\" style=\"aspect-ratio:%.6f;width:calc(80vh * %.6f)\">", width / height,
                   width / height) +
         "<svg role=\"img\" aria-label=\"" + label +
         plan_text("\" viewBox=\"%.3f %.3f %.3f %.3f\">\n", frame.low_m.x(), -frame.low_m.y() - height, width, height) +
         "<path class=\"grid\" d=\"" + ticks.grid + "\"/>\n" + body + "</svg>\n" + ticks.texts +
         "<span class=\"x axis\">x [m]</span><span class=\"y axis\">y [m]</span></div>\n";
}

}  // namespace helixnav::apps
