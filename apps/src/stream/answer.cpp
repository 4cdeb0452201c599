// SPDX-License-Identifier: BSD-3-Clause
#include "answer.hpp"

#include <nlohmann/json.hpp>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/words.hpp"

namespace helixnav::apps {
namespace {

using Json = nlohmann::ordered_json;

Json association_json(const core::AssociationReport& a) {
  Json json{{"observation", a.observation}, {"outcome", runs::word_of(runs::outcome_words, a.outcome)}};
  json["landmark"] = a.landmark == core::no_landmark ? Json() : Json(a.landmark);
  json["nis"] = a.nis;  // null if there was no pair
  json["dof"] = a.dof;
  return json;
}

Json associations_json(const std::vector<core::AssociationReport>& associations) {
  Json json = Json::array();
  for (const core::AssociationReport& a : associations) json.push_back(association_json(a));
  return json;
}

Json decision_json(const core::Decision& decision) {
  const core::DecisionRow row = core::row_of(decision);
  Json numbers = Json::object();
  for (const auto& [name, value] : row.numbers) numbers[name] = value;
  return {{"kind", row.kind},
          {"verdict", row.verdict},
          {"numbers", std::move(numbers)},
          {"sentence", reports::sentence_of(decision)}};
}

/// Changes to earlier answers; left out if there are none.
void add_changes(const core::StepReport& report, Json& json) {
  for (const core::MergedLandmarks& merge : report.merged) {
    json["merged"].push_back({{"kept", merge.kept}, {"removed", merge.removed}});
  }
  for (const core::RevisedScan& scan : report.revised) {
    json["revised"].push_back({{"step", scan.step}, {"associations", associations_json(scan.associations)}});
  }
}

std::string line_of(const char* key, Json value) {
  Json line;
  line[key] = std::move(value);
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string scan_answer(const core::StepReport& report, std::size_t line) {
  const Eigen::Matrix3d& P = report.pose.covariance;
  Json json{{"line", line},
            {"step", report.step},
            {"t", static_cast<double>(report.t_ns) / 1e9},  // the nearest double to the decimal
            {"t_ns", report.t_ns},
            {"x", report.pose.mean.x_m},
            {"y", report.pose.mean.y_m},
            {"heading", report.pose.mean.heading_rad}};
  json["covariance"] = {{P(0, 0), P(0, 1), P(0, 2)}, {P(0, 1), P(1, 1), P(1, 2)}, {P(0, 2), P(1, 2), P(2, 2)}};
  json["mode"] = runs::word_of(runs::mode_words, report.mode);
  json["landmarks"] = report.mapped_landmarks;
  json["numerics"] = {{"least_pivot", report.numerics.least_pivot},
                      {"asymmetry", report.numerics.asymmetry},
                      {"repaired", report.numerics.repaired},
                      {"refused", report.numerics.refused}};
  json["associations"] = associations_json(report.associations);
  json["decisions"] = Json::array();
  for (const core::Decision& decision : report.decisions) json["decisions"].push_back(decision_json(decision));
  add_changes(report, json);
  return line_of("scan", std::move(json));
}

std::string refused_answer(const logs::RefusedLine& refused) {
  Json json{{"line", refused.line}};
  json["key"] = refused.key.empty() ? Json() : Json(refused.key);
  json["why"] = refused.why;
  return line_of("refused", std::move(json));
}

std::string note_answer(const std::string& words) { return line_of("note", words); }

std::string end_answer(std::int64_t scans, std::int64_t refused, const std::string& why) {
  return line_of("end", {{"why", why}, {"scans", scans}, {"refused", refused}});
}

}  // namespace helixnav::apps
