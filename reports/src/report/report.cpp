// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/report.hpp"

#include <string_view>

#include "player/report_player.hpp"
#include "report_assets.hpp"
#include "report_data.hpp"
#include "report_smoothing.hpp"

namespace helixnav::reports {

namespace {

struct Filling {
  std::string_view name;
  std::string_view content;
};

// The page with each {{name}} replaced. Inserted text is not scanned again.
std::string fill(std::string_view page, const std::vector<Filling>& fillings) {
  std::string text;
  while (true) {
    const std::size_t begin = page.find("{{");
    text += page.substr(0, begin);
    if (begin == std::string_view::npos) return text;
    const std::size_t end = page.find("}}", begin);
    const std::string_view name = page.substr(begin + 2, end - begin - 2);
    for (const Filling& filling : fillings) {
      if (filling.name == name) text += filling.content;
    }
    page.remove_prefix(end + 2);
  }
}

// JSON that may stand inside a script element: no text in it can close the element.
std::string for_script(const Json& json) {
  const std::string plain = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char c : plain) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string render_report(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Json json = report_data(run, evaluation);
  if (run.smoothed) json["smoothing"] = smoothing_data(*run.smoothed);
  const std::string data = for_script(json);
  const std::string player = for_script(player_data(run, evaluation));
  const std::string wall_clock = for_script(report_wall_clock(run));
  return fill(report_page, {{"style", report_style},
                            {"data", data},
                            {"player_data", player},
                            {"wall_clock", wall_clock},
                            {"charts", report_charts},
                            {"script", report_script}});
}

}  // namespace helixnav::reports
