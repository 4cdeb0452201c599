// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "campaign.hpp"
#include "common/commands.hpp"
#include "common/fit_to_recording.hpp"
#include "helixnav/sim/scenario.hpp"
#include "merge_campaigns.hpp"
#include "settings/config_file.hpp"
#include "settings/memory_limit.hpp"
#include "settings/scenario_settings.hpp"
#include "settings/settings.hpp"
#include "settings/validators.hpp"
#include "team_campaign.hpp"

namespace helixnav::apps {
namespace {

struct MonteCarloJob {
  std::string scenario;
  std::string config;
  std::vector<std::string> parts;  ///< to merge; empty: drive
  Campaign campaign;
  ScenarioSettings scenario_settings;
  Settings settings;
};

/// The worlds of several robots; they have no settings.
ExitCode run_team(const GivenOptions& given, const MonteCarloJob& job) {
  if (!given.empty()) throw CLI::ValidationError("--" + key_of(**given.begin()), "has no part in montecarlo team");
  if (!job.config.empty()) throw CLI::ValidationError("--config", "has no part in montecarlo team");
  TeamCampaign team;
  team.runs = job.campaign.runs;
  team.first_seed = job.campaign.first_seed;
  team.jobs = job.campaign.jobs;
  team.out = job.campaign.out;
  team.overwrite = job.campaign.overwrite;
  team.quiet = job.campaign.quiet;
  return run_team_campaign(team);
}

std::vector<std::string> names_of_campaigns() {
  std::vector<std::string> names = sim::scenario_names();
  names.emplace_back("team");
  return names;
}

/// Nothing is driven: options for a drive must have been meant otherwise.
ExitCode merge(const CLI::App& command, const GivenOptions& given, const MonteCarloJob& job) {
  if (!given.empty()) throw CLI::ValidationError("--" + key_of(**given.begin()), "has no part in --merge");
  for (const char* name : {"SCENARIO", "--runs", "--first-seed", "--seeds", "--jobs", "--config"}) {
    if (command.get_option(name)->count() > 0) throw CLI::ValidationError(name, "has no part in --merge");
  }
  merge_campaigns(job.parts, job.campaign.out, job.campaign.overwrite);
  return ExitCode::ok;
}

ExitCode run(CLI::App& command, MonteCarloJob& job) {
  const GivenOptions given = options_given(command);
  if (!job.parts.empty()) return merge(command, given, job);
  if (job.scenario.empty()) throw CLI::RequiredError("SCENARIO");
  if (job.scenario == "team") return run_team(given, job);
  if (!job.config.empty()) apply_config_file(command, job.config);
  require_compressed_ekf(command, given, job.settings.fastslam,
                         "campaigns are of the compressed EKF; simulate takes it");
  refuse_memory_limit(job.settings, "the runs of a campaign share the process");
  Campaign& campaign = job.campaign;
  campaign.scenario = scenario_of(job.scenario, job.scenario_settings);
  const core::FieldOfView& view = campaign.scenario.scanner.field_of_view;
  campaign.navigator = fit_to_sensor(job.settings, view);
  campaign.navigator.search.relocalizer.threads = 1;  // the runs themselves fill the cores
  campaign.known_association = job.settings.known_association;
  campaign.config = dump_config(command) + lengths_text(campaign.navigator, view);
  return run_campaign(campaign);
}

constexpr std::uint64_t most_runs = 10'000'000;

std::optional<std::pair<std::uint64_t, std::uint64_t>> seeds_from(const std::string& word) {
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto number = [](const std::string& text) -> std::optional<std::uint64_t> {
    constexpr std::size_t most_digits = 18;
    const bool digits = !text.empty() && text.size() <= most_digits &&
                        std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    return digits ? std::optional<std::uint64_t>(std::stoull(text)) : std::nullopt;
  };
  const auto first = number(word.substr(0, colon)), last = number(word.substr(colon + 1));
  if (!first || !last || *first > *last || *last - *first >= most_runs) return std::nullopt;
  return std::pair(*first, *last);
}

void add_seeds(CLI::App& command, Campaign& campaign) {
  const auto take = [&campaign](const std::string& word) {
    const auto seeds = seeds_from(word);
    if (!seeds) return;
    campaign.first_seed = seeds->first;
    campaign.runs = seeds->second - seeds->first + 1;
  };
  command
      .add_option_function<std::string>("--seeds", take, "Seeds A to B, both in it: a part of a campaign, for --merge")
      ->type_name("A:B")
      ->check([](const std::string& word) {
        return seeds_from(word)
                   ? std::string()
                   : "'" + word + "': expected A:B, whole numbers, A not above B, at most ten million seeds";
      })
      ->excludes("--runs")
      ->excludes("--first-seed");
}

void add_options(CLI::App& command, MonteCarloJob& job) {
  command
      .add_option("SCENARIO", job.scenario,
                  "As for simulate; team: robots of unknown start without names (docs/team.md)")
      ->check(one_of(names_of_campaigns()));
  command.add_option("--runs", job.campaign.runs, "How many seeds")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{1}, most_runs));
  command.add_option("--first-seed", job.campaign.first_seed, "Seed of the first run; the next ones follow it")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max() / 2));
  add_seeds(command, job.campaign);
  command
      .add_option("--merge", job.parts,
                  "Drive nothing: make one campaign in --out of these, parts of one that were driven by --seeds")
      ->type_name("PART...")
      ->expected(1, 100'000);
  job.campaign.jobs = std::max(1u, std::thread::hardware_concurrency());
  command.add_option("--jobs", job.campaign.jobs, "Runs at a time; results do not depend on it. Default: every core")
      ->check(number_between(1u, 1024u));
  command
      .add_option("--out", job.campaign.out,
                  "Folder of the campaign; one that was begun by the same scenario, settings and build is gone on with")
      ->required()
      ->type_name("DIR");
  command.add_flag("--overwrite", job.campaign.overwrite, "Begin the campaign in --out anew");
  command.add_flag("--quiet", job.campaign.quiet, "No progress bar");
  command.add_option("--config", job.config, "INI or TOML file of the settings below (helixnav config --dump)")
      ->type_name("FILE");
}

}  // namespace

void add_montecarlo_command(CLI::App& app, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("montecarlo", "Run a scenario with many seeds and judge every run against the truth");
  const auto job = std::make_shared<MonteCarloJob>();
  add_options(*command, *job);
  add_scenario_settings(*command, job->scenario_settings);
  add_settings(*command, job->settings);
  command->footer(
      "Writes runs.jsonl, a line a run as it ends, and summary.json (docs/campaign.md); prints the summary. A "
      "campaign\n"
      "that was interrupted continues with the same command. On many machines: examples/campaign.\n\n"
      "Examples:\n"
      "  helixnav montecarlo large-loop-changed --runs 1000 --out campaigns/changed\n"
      "  helixnav montecarlo large-loop-changed --seeds 501:1000 --out campaigns/part_2\n"
      "  helixnav montecarlo --merge campaigns/part_1 campaigns/part_2 --out campaigns/changed\n"
      "  helixnav montecarlo sparse --association nearest-neighbour --out campaigns/sparse-nn\n");
  command->callback([command, job, &code] { code = run(*command, *job); });
}

}  // namespace helixnav::apps
