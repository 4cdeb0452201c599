// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <string>
#include <utility>

#include "campaign_number.hpp"
#include "campaign_summary.hpp"

namespace helixnav::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of_share(const char* name, const Json& value) {
  char line[160];
  std::snprintf(line, sizeof(line), "  %-34s %6.1f %%   [%.2f, %.2f]   %d\n", name, number(value, "percent"),
                value.at("interval_95_percent").at(0).is_number() ? value.at("interval_95_percent").at(0).get<double>()
                                                                  : no_number,
                value.at("interval_95_percent").at(1).is_number() ? value.at("interval_95_percent").at(1).get<double>()
                                                                  : no_number,
                value.at("count").get<int>());
  return line;
}

std::string text_of_quantiles(const char* name, const Json& value) {
  char line[160];
  std::snprintf(line, sizeof(line), "  %-34s median %.2f, p90 %.2f, max %.2f   (%d)\n", name, number(value, "median"),
                number(value, "p90"), number(value, "max"), value.at("count").get<int>());
  return line;
}

std::string text_of_nees(const char* name, const Json& value) {
  char line[160];
  if (value.at("count").get<int>() == 0) {
    std::snprintf(line, sizeof(line), "  %-34s none\n", name);
    return line;
  }
  std::snprintf(line, sizeof(line), "  %-34s mean %.2f, band [%.2f, %.2f], median %.2f   (%d)\n", name,
                number(value, "mean"), value.at("band_95").at(0).get<double>(), value.at("band_95").at(1).get<double>(),
                number(value, "median"), value.at("count").get<int>());
  return line;
}

std::string shares_text(const Json& summary) {
  std::string text;
  for (const auto& [key, name] :
       {std::pair("closed", "closed"), std::pair("false", "false"), std::pair("undecided", "undecided"),
        std::pair("failed", "failed"), std::pair("diverged_after_closure", "diverged after closure"),
        std::pair("closed_by_association", "closed by association alone"),
        std::pair("wrong_before_trigger", "wrong match before the trigger"),
        std::pair("wrong_without_trigger", "wrong match, never a trigger"),
        std::pair("rolled_back", "rolled back and relocalised"),
        std::pair("any_wrong_old_match", "any wrong match with old ground"),
        std::pair("error_at_return_exceeds_spacing", "error at return > spacing"),
        std::pair("wrong_at_end", "wrong at the end of the drive"),
        std::pair("absolutely_wrong_at_closing", "wrong at closing, map frame"),
        std::pair("absolutely_wrong_at_end", "wrong at the end, map frame")}) {
    text += text_of_share(name, summary.at(key));
  }
  return text;
}

std::string figures_text(const Json& summary) {
  std::string text = text_of_quantiles("metres from re-entry to closure", summary.at("metres_to_closure"));
  text += text_of_quantiles("position error at closing [m]", summary.at("position_error_at_closing_m"));
  text += text_of_quantiles("position error at the end [m]", summary.at("position_error_at_end_m"));
  text += text_of_nees("NEES at closing", summary.at("nees_at_closing"));
  text += text_of_nees("NEES at the end", summary.at("nees_at_end"));
  text += text_of_quantiles("rival's share of the winner's ratio", summary.at("rival_share"));
  text += text_of_quantiles("map RMS, aligned [m]", summary.at("map_rms_m"));
  return text;
}

std::string counts_text(const Json& summary) {
  const Json& closures = summary.at("closures");
  char line[200];
  std::snprintf(line, sizeof(line), "  %-34s %.0f of %.0f; closures refused %.0f\n", "wrong pairs of closings",
                number(closures, "wrong_pairs"), number(closures, "pairs"), number(closures, "refused"));
  std::string text = line;
  std::snprintf(line, sizeof(line), "  %-34s %.0f, %.2f %% of the trees\n", "duplicates",
                number(summary.at("duplicates"), "count"), number(summary.at("duplicates"), "percent_of_trees"));
  text += line;
  std::snprintf(line, sizeof(line), "  %-34s %.0f, %.2f %% of the mature landmarks\n", "landmarks that are no tree",
                number(summary.at("not_trees"), "count"), number(summary.at("not_trees"), "percent_of_landmarks"));
  text += line;
  const Json& slips = summary.at("slips");
  std::snprintf(line, sizeof(line), "  %-34s %.0f decided, %.0f of them unfounded, %.0f happened\n", "slips",
                number(slips, "decided"), number(slips, "unfounded"), number(slips, "happened"));
  return text + line;
}

}  // namespace

std::string summary_text(const Json& summary) {
  std::string text = summary.at("scenario").get<std::string>() + ": " + summary.at("runs").dump() + " runs";
  if (summary.contains("seeds")) {
    text += ", seeds " + summary.at("seeds").at(0).dump() + " to " + summary.at("seeds").at(1).dump();
  }
  text += "; shares with their 95 % interval and count\n";
  text += shares_text(summary) + figures_text(summary) + counts_text(summary);
  for (const char* key : {"run_s", "search_s", "closing_s"}) {
    text += text_of_quantiles((std::string("wall clock, ") + key).c_str(), summary.at("wall").at(key));
  }
  return text;
}

}  // namespace helixnav::apps
