// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/hand_over.hpp"
#include "convert_log.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "settings/validators.hpp"

namespace helixnav::apps {
namespace {

struct ConvertJob {
  std::string in;
  std::string out;
  std::string to;
  std::vector<std::string> noise;  ///< FIELD=SIGMA
  std::uint64_t seed = 1;
  bool overwrite = false;
};

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const logs::NoiseField field : logs::noise_fields()) names.push_back(logs::name_of(field));
  return names;
}

/// "range_m=0.1". CLI::ValidationError names the nearest field or what is wrong with the number.
logs::Noise noise_of(const std::string& word) {
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  std::string sigma = equals == std::string::npos ? "" : word.substr(equals + 1);
  const auto refuse = [](const std::string& why) { throw CLI::ValidationError("--noise", why); };
  if (equals == std::string::npos) refuse("expected FIELD=SIGMA such as range_m=0.1, found '" + word + "'");
  if (const std::string why = one_of(field_names())(name); !why.empty()) refuse(why);
  if (const std::string why = number_between(1e-12, 1e6)(sigma); !why.empty()) refuse(name + ": " + why);
  logs::Noise noise;
  CLI::detail::lexical_cast(sigma, noise.sigma);
  for (const logs::NoiseField field : logs::noise_fields()) {
    if (logs::name_of(field) == name) noise.field = field;
  }
  return noise;
}

GraphFormat format_of(const ConvertJob& job) {
  const std::string extension = std::filesystem::path(job.out).extension().string();
  if (const auto format = format_by_name(job.to)) return *format;
  if (const auto format = format_by_extension(extension)) return *format;
  throw CLI::ValidationError(
      "OUT", "'" + extension + "' says no format; give --to " + CLI::detail::join(format_names(), ", --to ") +
                 ", or an extension of .circles, .lines, .dlr, .g2o, .isam, .gtsam, .jsonl, .rawlog");
}

bool is_rawlog(const std::string& path) { return std::filesystem::path(path).extension() == ".rawlog"; }

[[noreturn]] void convert_rawlog(const ConvertJob& job) {
  if (!job.noise.empty()) throw CLI::ValidationError("--noise", "goes to no rawlog; add it to IN first, then convert");
  std::vector<std::string> arguments{job.in, job.out};
  if (!job.to.empty()) arguments.insert(arguments.end(), {"--to", job.to});
  if (job.overwrite) arguments.emplace_back("--overwrite");
  hand_over("helixnav-rawlog", arguments);
}

/// OUT must be neither IN nor a table of the folder IN; a file that convert wrote there with its own extension is not a
/// table.
void refuse_to_replace_log(const ConvertJob& job) {
  namespace fs = std::filesystem;
  std::error_code none;  // a file that does not exist yet is a different one
  const bool is_log = fs::equivalent(job.in, job.out, none);
  const bool is_in_log = fs::exists(job.out) && fs::is_directory(job.in) &&
                         fs::equivalent(job.in, fs::canonical(job.out).parent_path(), none) &&
                         !format_by_extension(fs::path(job.out).extension().string());
  if (!is_log && !is_in_log) return;
  throw core::InputError(job.out + ": " + job.in + " is read, and would be lost by writing there; choose another name");
}

ExitCode convert(const ConvertJob& job) {
  if (is_rawlog(job.in) || (is_rawlog(job.out) && job.to.empty())) convert_rawlog(job);
  const GraphFormat format = format_of(job);
  std::vector<logs::Noise> noises;
  for (const std::string& word : job.noise) noises.push_back(noise_of(word));
  namespace fs = std::filesystem;
  if (fs::is_directory(job.out)) throw core::InputError(job.out + ": expected a file to write, found a folder");
  if (fs::exists(job.out) && !job.overwrite) {
    throw core::InputError(job.out + ": the file is there already; choose another name, or --overwrite to replace it");
  }
  refuse_to_replace_log(job);
  const Converted converted = convert_log(job.in, job.out, format, noises, job.seed, job.overwrite);
  std::fputs(text_of(converted).c_str(), stdout);
  std::printf("written: %s (%s)\n", job.out.c_str(), name_of(format).c_str());
  return ExitCode::ok;
}

}  // namespace

void add_convert_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("convert", "Write a labelled log or graph in another format, or with noise");
  const auto job = std::make_shared<ConvertJob>();
  command->add_option("IN", job->in, "Labelled log or graph; the format is recognised")->required();
  command->add_option("OUT", job->out, "File to write; its extension is the format")->required();
  command->add_option("--to", job->to, "Format of OUT, whatever its name")->check(one_of(format_names()));
  command
      ->add_option("--noise", job->noise,
                   "Add white Gaussian noise of this standard deviation, and its variance to the covariances;\n"
                   "several with commas between them. FIELD is one of " +
                       CLI::detail::join(field_names(), ", "))
      ->type_name("FIELD=SIGMA")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--seed", job->seed, "Seed of the noise")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()));
  command->add_flag("--overwrite", job->overwrite,
                    "Replace OUT, and the vehicle.toml beside JSON Lines, when they are there");
  command->footer(
      "Formats by extension: .circles .lines .dlr (DLR text, robot axes X left, Y backward), .g2o, .isam (square-root\n"
      "information), .gtsam (covariances), .jsonl (JSON Lines of your own schema, with a vehicle.toml beside them). "
      "The\n"
      "graph formats hold what has a label; DLR text and JSON Lines hold all.\n"
      "A .rawlog of MRPT, as IN or OUT, is converted by helixnav-rawlog, which says more (--help).\n\n"
      "Examples:\n"
      "  helixnav convert map.circles run_e.g2o\n"
      "  helixnav convert victoria_park_ascii.zip park.rawlog\n"
      "  helixnav convert map.circles noisy.circles --noise odometry_heading_rad=0.01,point_x_m=0.05 --seed 3\n");
  command->callback([job, &code] { code = convert(*job); });
}

}  // namespace helixnav::apps
