// SPDX-License-Identifier: BSD-3-Clause
#include "team_campaign_table.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <boost/math/distributions/binomial.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/number_text.hpp"

namespace helixnav::apps {
namespace {

/// Two-sided 95 % Clopper-Pearson interval.
nlohmann::ordered_json share_of(std::size_t hits, std::size_t trials) {
  using boost::math::binomial_distribution;
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(hits);
  constexpr double tail = 0.025;
  return {{"count", hits},
          {"of", trials},
          {"low_95", binomial_distribution<>::find_lower_bound_on_p(n, k, tail)},
          {"high_95", binomial_distribution<>::find_upper_bound_on_p(n, k, tail)}};
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Throws std::exception of the standard library if it is not a number.
TeamWorld world_of(const std::vector<std::string>& cells) {
  TeamWorld world;
  world.seed = std::stoull(cells.at(0));
  for (const TeamTrial& trial : trials_of(world.seed)) {
    if (trial.name == cells.at(1)) world.trial = trial;
  }
  TeamVerdict& verdict = world.verdict;
  verdict.failed = std::stoi(cells.at(4)) != 0;
  verdict.joined = std::stoi(cells.at(5)) != 0;
  verdict.wrong = std::stoi(cells.at(6)) != 0;
  verdict.t_s = std::stod(cells.at(7));
  verdict.merged = std::stoi(cells.at(8));
  verdict.merged_wrong = std::stoi(cells.at(9));
  verdict.error_m = std::stod(cells.at(10));
  verdict.error_rad = std::stod(cells.at(11));
  return world;
}

}  // namespace

const char* const team_columns =
    "seed,world,pitch_m,jitter_m,failed,joined,wrong,t_s,merged,merged_wrong,error_m,error_rad\n";

std::vector<TeamWorld> read_team_rows(const std::string& folder) {
  const std::string file = folder + '/' + team_rows_name;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw core::InputError(file + ": cannot be read");
  std::vector<TeamWorld> worlds;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line) && !stream.eof(); ++number) {
    const std::string here = file + ':' + std::to_string(number) + ": expected ";
    if (number == 1) {
      if (line + '\n' != team_columns) throw core::InputError(here + "the columns of a campaign of teams");
      continue;
    }
    try {
      worlds.push_back(world_of(cells_of(line)));
    } catch (const std::exception&) {
      throw core::InputError(here + "a world of a campaign of teams, found \"" + line.substr(0, 60) + '"');
    }
    if (worlds.back().trial.name.empty())
      throw core::InputError(here + "a kind of world, found \"" + line.substr(0, 60) + '"');
  }
  return worlds;
}

std::string team_rows(const std::vector<TeamWorld>& worlds, std::size_t from, std::size_t count) {
  std::string text;
  for (std::size_t i = from; i < from + count; ++i) {
    const TeamWorld& world = worlds[i];
    const TeamVerdict& verdict = world.verdict;
    const bool lattice = world.trial.world.kind == sim::TeamWorldKind::orchard;
    text += std::to_string(world.seed) + ',' + world.trial.name + ',';
    if (lattice) files::append_number(text, world.trial.world.pitch_m);
    text += ',';
    if (lattice) files::append_number(text, world.trial.world.jitter_m);
    text +=
        std::string(verdict.failed ? ",1" : ",0") + (verdict.joined ? ",1" : ",0") + (verdict.wrong ? ",1," : ",0,");
    files::append_number(text, verdict.t_s);
    text += ',' + std::to_string(verdict.merged) + ',' + std::to_string(verdict.merged_wrong) + ',';
    files::append_number(text, verdict.error_m);
    text += ',';
    files::append_number(text, verdict.error_rad);
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json team_campaign_summary(const std::vector<TeamWorld>& worlds) {
  nlohmann::ordered_json json;
  for (const TeamTrial& trial : trials_of(0)) {
    std::size_t count = 0, failed = 0, joined = 0, wrong = 0;
    int merged = 0, merged_wrong = 0;
    std::vector<double> errors_m;
    for (const TeamWorld& world : worlds) {
      if (world.trial.name != trial.name) continue;
      ++count;
      failed += world.verdict.failed ? 1 : 0;
      joined += world.verdict.joined ? 1 : 0;
      wrong += world.verdict.wrong ? 1 : 0;
      merged += world.verdict.merged;
      merged_wrong += world.verdict.merged_wrong;
      if (world.verdict.joined && !world.verdict.wrong) errors_m.push_back(world.verdict.error_m);
    }
    nlohmann::ordered_json& one = json[trial.name];
    one["failed"] = failed;
    one["joined"] = share_of(joined, count);
    one["false"] = share_of(wrong, count);
    one["landmarks_merged"] = merged;
    one["landmarks_merged_wrong"] = merged_wrong;
    if (errors_m.empty()) continue;
    std::sort(errors_m.begin(), errors_m.end());
    one["median_error_m"] = errors_m[errors_m.size() / 2];
    one["max_error_m"] = errors_m.back();
  }
  return json;
}

void print_team_campaign(const nlohmann::ordered_json& summary) {
  for (const auto& [name, figures] : summary.items()) {
    const auto& joined = figures["joined"];
    const auto& wrong = figures["false"];
    std::printf("%-8s joined %zu of %zu [%.1f, %.1f] %%, falsely %zu (at most %.2f %%)", name.c_str(),
                joined["count"].get<std::size_t>(), joined["of"].get<std::size_t>(),
                100.0 * joined["low_95"].get<double>(), 100.0 * joined["high_95"].get<double>(),
                wrong["count"].get<std::size_t>(), 100.0 * wrong["high_95"].get<double>());
    if (figures.contains("median_error_m")) {
      std::printf("; error median %.3f m, max %.3f m", figures["median_error_m"].get<double>(),
                  figures["max_error_m"].get<double>());
    }
    if (figures["failed"] > 0) std::printf("; failed %zu", figures["failed"].get<std::size_t>());
    std::printf("; landmarks merged %d, of them wrongly %d\n", figures["landmarks_merged"].get<int>(),
                figures["landmarks_merged_wrong"].get<int>());
  }
}

}  // namespace helixnav::apps
