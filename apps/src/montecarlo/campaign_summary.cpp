// SPDX-License-Identifier: BSD-3-Clause
#include "campaign_summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <boost/math/distributions/binomial.hpp>

#include "campaign_number.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/evaluation/referee.hpp"

namespace helixnav::apps {
namespace {

using Json = nlohmann::ordered_json;
using Condition = std::function<bool(const Json&)>;

Json list(const Json& row, const char* key) { return row.value(key, Json::array()); }

bool has_verdict(const Json& row, const char* verdict) { return row.at("verdict") == verdict; }

Json share(const std::vector<Json>& rows, const Condition& condition) {
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(rows.size());
  const auto k = static_cast<double>(std::count_if(rows.begin(), rows.end(), condition));
  Json json = {{"count", static_cast<std::int64_t>(k)}};
  json["percent"] = n > 0.0 ? 100.0 * k / n : no_number;
  const double low = n > 0.0 ? 100.0 * Binomial::find_lower_bound_on_p(n, k, 0.025) : no_number;
  const double high = n > 0.0 ? 100.0 * Binomial::find_upper_bound_on_p(n, k, 0.025) : no_number;
  json["interval_95_percent"] = {low, high};
  return json;
}

Json quantiles(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }), values.end());
  std::sort(values.begin(), values.end());
  return {{"count", values.size()},
          {"median", evaluation::quantile_of_sorted(values, 0.5)},
          {"p90", evaluation::quantile_of_sorted(values, 0.9)},
          {"max", values.empty() ? no_number : values.back()}};
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Json nees(std::vector<double> values) {
  constexpr int pose_dof = 3;
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }), values.end());
  const auto n = static_cast<double>(values.size());
  Json json = {{"count", values.size()}};
  json["mean"] = values.empty() ? no_number : sum(values) / n;
  const int dof = pose_dof * static_cast<int>(values.size());
  json["band_95"] =
      values.empty() ? Json(nullptr) : Json({core::chi2_quantile(0.025, dof) / n, core::chi2_quantile(0.975, dof) / n});
  json["median"] = quantiles(values).at("median");
  return json;
}

/// The figure of every row, or of every item in a list of the rows.
std::vector<double> of_rows(const std::vector<Json>& rows, const char* key) {
  std::vector<double> values;
  for (const Json& row : rows) values.push_back(number(row, key));
  return values;
}

std::vector<double> of_lists(const std::vector<Json>& rows, const char* where, const char* key) {
  std::vector<double> values;
  for (const Json& row : rows) {
    for (const Json& item : list(row, where)) values.push_back(number(item, key));
  }
  return values;
}

std::vector<double> of_parts(const std::vector<Json>& rows, const char* where, const char* key) {
  std::vector<double> values;
  for (const Json& row : rows) values.push_back(number(row.value(where, Json::object()), key));
  return values;
}

std::vector<Json> chosen(const std::vector<Json>& rows, const Condition& condition) {
  std::vector<Json> those;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(those), condition);
  return those;
}

bool is_wrong_absolutely(const Json& pose) {
  const evaluation::RefereeOptions limits;
  return number(pose, "absolute_position_error_m") > limits.wrong_position_m ||
         number(pose, "absolute_heading_error_deg") * core::pi / 180.0 > limits.wrong_heading_rad;
}

bool any_closure(const Json& row, const Condition& condition) {
  const Json closures = list(row, "closures");
  return std::any_of(closures.begin(), closures.end(), condition);
}

bool exceeds_spacing(const Json& row) {
  const Json returns = list(row, "returns");
  return !returns.empty() && number(returns.front(), "error_before_m") > number(row, "spacing_m");
}

void put_shares(Json& summary, const std::vector<Json>& rows) {
  const evaluation::RefereeOptions limits;
  const auto verdict = [](const char* word) { return [word](const Json& row) { return has_verdict(row, word); }; };
  summary["closed"] = share(rows, verdict("closed"));
  summary["false"] = share(rows, verdict("false"));
  summary["undecided"] = share(rows, verdict("undecided"));
  summary["failed"] = share(rows, verdict("failed"));
  summary["diverged_after_closure"] = share(rows, [](const Json& row) {
    return row.value("diverged_after_closure", row.value("late", false));  // "late" in rows of earlier versions
  });
  summary["closed_by_association"] =
      share(rows, [](const Json& row) { return row.value("closed_by_association", false); });
  summary["wrong_before_trigger"] =
      share(rows, [](const Json& row) { return number(row, "wrong_before_trigger") > 0; });
  summary["wrong_without_trigger"] =
      share(rows, [](const Json& row) { return number(row, "wrong_without_trigger") > 0; });
  summary["rolled_back"] = share(rows, [](const Json& row) {
    return number(row, row.contains("rolled_back") ? "rolled_back" : "rewound") > 0;  // "rewound" in earlier versions
  });
  summary["any_wrong_old_match"] = share(rows, [](const Json& row) { return number(row, "wrong_old_matches") > 0; });
  summary["error_at_return_exceeds_spacing"] = share(rows, exceeds_spacing);
  summary["absolutely_wrong_at_closing"] =
      share(rows, [](const Json& row) { return any_closure(row, is_wrong_absolutely); });
  summary["wrong_at_end"] = share(rows, [&limits](const Json& row) {
    return has_verdict(row, "closed") &&
           number(row.value("end", Json::object()), "position_error_m") > limits.wrong_position_m;
  });
  summary["absolutely_wrong_at_end"] = share(rows, [&limits](const Json& row) {
    return has_verdict(row, "closed") &&
           number(row.value("end", Json::object()), "absolute_position_error_m") > limits.wrong_position_m;
  });
}

void put_closures(Json& summary, const std::vector<Json>& rows, const std::vector<Json>& closed) {
  const std::vector<double> pairs = of_lists(rows, "closures", "pairs");
  summary["closures"] = {
      {"accepted", pairs.size()},
      {"refused", sum(of_rows(chosen(rows, [](const Json& r) { return r.contains("refused"); }), "refused"))},
      {"pairs", sum(pairs)},
      {"wrong_pairs", sum(of_lists(rows, "closures", "wrong_pairs"))}};
  summary["metres_to_closure"] = quantiles(of_lists(closed, "closures", "after_reentry_m"));
  summary["rival_share"] = quantiles(of_lists(rows, "closures", "rival_share"));
  summary["position_error_at_closing_m"] = quantiles(of_lists(rows, "closures", "position_error_m"));
  summary["position_error_at_end_m"] = quantiles(of_parts(closed, "end", "position_error_m"));
  std::vector<double> first;  // closures of one run are not independent
  for (const Json& row : rows) {
    if (!list(row, "closures").empty()) first.push_back(number(list(row, "closures").front(), "nees"));
  }
  summary["nees_at_closing"] = nees(first);
  summary["nees_at_end"] = nees(of_parts(closed, "end", "nees"));
}

void put_slips(Json& summary, const std::vector<Json>& rows) {
  Json slips;
  for (const auto& [name, key] : {std::pair("happened", "slips"), std::pair("decided", "slips_decided"),
                                  std::pair("unfounded", "slips_unfounded")}) {
    const char* const wanted = key;
    slips[name] = sum(of_rows(chosen(rows, [wanted](const Json& r) { return r.contains(wanted); }), key));
  }
  summary["slips"] = slips;
}

void put_map(Json& summary, const std::vector<Json>& rows, const std::vector<Json>& closed) {
  const double duplicates = sum(of_rows(closed, "duplicates"));
  const double trees = sum(of_rows(closed, "trees_seen"));
  summary["duplicates"] = {{"count", duplicates},
                           {"percent_of_trees", trees > 0.0 ? 100.0 * duplicates / trees : no_number}};
  const auto counts_them = [](const Json& row) {
    return row.contains("not_trees");
  };  // rows of earlier versions do not
  const std::vector<Json> counted = chosen(rows, counts_them);
  const double not_trees = sum(of_rows(counted, "not_trees"));
  const double mature = sum(of_rows(counted, "mature_landmarks"));
  summary["not_trees"] = {{"count", not_trees},
                          {"percent_of_landmarks", mature > 0.0 ? 100.0 * not_trees / mature : no_number}};
  summary["map_rms_m"] = quantiles(of_rows(closed, "map_rms_m"));
}

}  // namespace

Json summary_of(const std::string& scenario, const std::vector<Json>& rows) {
  const std::vector<Json> closed = chosen(rows, [](const Json& row) { return has_verdict(row, "closed"); });
  Json summary = {{"scenario", scenario}, {"runs", rows.size()}};
  if (!rows.empty()) summary["seeds"] = {rows.front().at("seed"), rows.back().at("seed")};
  put_shares(summary, rows);
  put_closures(summary, rows, closed);
  put_map(summary, rows, closed);
  put_slips(summary, rows);
  summary["wall"] = {{"run_s", quantiles(of_parts(rows, "wall", "run_s"))},
                     {"search_s", quantiles(of_parts(rows, "wall", "search_s"))},
                     {"closing_s", quantiles(of_parts(rows, "wall", "closing_s"))}};
  return summary;
}

}  // namespace helixnav::apps
