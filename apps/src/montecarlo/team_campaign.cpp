// SPDX-License-Identifier: BSD-3-Clause
#include "team_campaign.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include <boost/math/distributions/binomial.hpp>
#include <nlohmann/json.hpp>

#include "common/progress_bar.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/worker_pool.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "team_trial.hpp"

namespace helixnav::apps {
namespace {

struct World {
  std::uint64_t seed = 0;
  TeamTrial trial;
  TeamVerdict verdict;
};

constexpr const char* columns =
    "seed,world,pitch_m,jitter_m,failed,joined,wrong,t_s,merged,merged_wrong,error_m,error_rad\n";

std::string rows_of(const std::vector<World>& worlds, std::size_t from, std::size_t count) {
  std::string text;
  for (std::size_t i = from; i < from + count; ++i) {
    const World& world = worlds[i];
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

/// Clopper and Pearson's two-sided 95 % interval.
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

nlohmann::ordered_json summary_of(const std::vector<World>& worlds) {
  nlohmann::ordered_json json;
  for (const TeamTrial& trial : trials_of(0)) {
    std::size_t count = 0, failed = 0, joined = 0, wrong = 0;
    int merged = 0, merged_wrong = 0;
    std::vector<double> errors_m;
    for (const World& world : worlds) {
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

void print(const nlohmann::ordered_json& summary) {
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

void make_folder(const TeamCampaign& campaign) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(campaign.out, error);
  if (error) throw core::InputError(campaign.out + ": cannot make the folder: " + error.message());
  if (campaign.overwrite || fs::is_empty(campaign.out)) return;
  throw core::InputError(campaign.out + ": the folder is not empty; choose another --out, or --overwrite");
}

std::vector<World> worlds_of(const TeamCampaign& campaign) {
  std::vector<World> worlds;
  for (std::uint64_t run = 0; run < campaign.runs; ++run) {
    const std::uint64_t seed = campaign.first_seed + run;
    for (const TeamTrial& trial : trials_of(seed)) worlds.push_back({seed, trial, {}});
  }
  return worlds;
}

}  // namespace

ExitCode run_team_campaign(const TeamCampaign& campaign) {
  make_folder(campaign);
  std::vector<World> worlds = worlds_of(campaign);
  core::WorkerPool workers(campaign.jobs);
  ProgressBar progress("driving", worlds.size(), campaign.quiet);
  const std::size_t batch = std::size_t{4} * campaign.jobs;
  std::filesystem::remove(campaign.out + "/runs.csv");
  files::AppendFile table(campaign.out + "/runs.csv");
  table.append(columns);
  for (std::size_t done = 0; done < worlds.size(); done += batch) {
    const std::size_t count = std::min(batch, worlds.size() - done);
    workers.for_each(count, [&](std::size_t i) {
      World& world = worlds[done + i];
      world.verdict = judge_world(world.trial, world.seed);
    });
    table.append(rows_of(worlds, done, count));
    progress.advance_to(done + count);
  }
  const nlohmann::ordered_json summary = summary_of(worlds);
  files::write_whole_file(campaign.out + "/summary.json", summary.dump(2) + '\n');
  print(summary);
  return ExitCode::ok;
}

}  // namespace helixnav::apps
