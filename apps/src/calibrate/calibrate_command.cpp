// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "calibration.hpp"
#include "common/commands.hpp"
#include "common/interrupt.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/logs/shipped_vehicle.hpp"
#include "settings/config_file.hpp"
#include "settings/deprecated_keys.hpp"
#include "settings/memory_limit.hpp"
#include "settings/settings.hpp"
#include "settings/vehicle_option.hpp"
#include "stop_if_interrupted.hpp"
#include "vehicle_text.hpp"

namespace helixnav::apps {
namespace {

struct CalibrateJob {
  std::string path;
  std::string vehicle;
  std::string config;
  std::string out;
  Settings settings;
};

/// The vehicle whose noise is judged: given, beside the log, or the one that ships for its format.
logs::Vehicle vehicle_of(const CalibrateJob& job) {
  const logs::LogFormat format = logs::recognise(job.path);
  if (job.settings.logs.vehicle) return *job.settings.logs.vehicle;
  if (const auto ships = logs::shipped_vehicle_of(format)) return logs::shipped_vehicle(*ships);
  throw core::InputError(job.path +
                         ": calibrate begins with a vehicle.toml (--vehicle FILE); 'helixnav new-vehicle' writes an "
                         "example");
}

/// With noise set in addition to the vehicle file, the factors would not refer to the noise in the file.
void refuse_noise_beside_file(const GivenOptions& given) {
  for (const CLI::Option* option : given) {
    const std::string key = key_of(*option);
    const bool of_vehicle =
        key.rfind("victoria_park.", 0) == 0 || key.rfind("car_park.", 0) == 0 || key.rfind("plaza.sigma", 0) == 0;
    if (of_vehicle || key == "log.covariance_scale") {
      throw CLI::ValidationError("--" + key,
                                 "calibrate judges the vehicle file; write it there and give --vehicle FILE");
    }
  }
}

void print_scale(const char* what, const smoothing::NoiseScale& scale) {
  const double factor = scale.factor;
  std::printf("%-11s noise x %.3f (95 %%: %.3f to %.3f; judged by %.0f residuals): %s than assumed\n", what, factor,
              scale.low_95, scale.high_95, scale.redundancy,
              scale.low_95 <= 1.0 && scale.high_95 >= 1.0 ? "not different"
              : factor > 1.0                              ? "worse"
                                                          : "better");
}

std::string verdict_on(const ConstantFound& found) {
  std::array<char, 160> text{};
  const double unit = found.constant.unit;
  switch (found.verdict) {
    case Verdict::not_observable:
      return "not observable from this log: left as given";
    case Verdict::unsettled:
      return "observable; alternates between rounds: left as given";
    case Verdict::indistinguishable:
      return "observable; indistinguishable from the given value: left as given";
    case Verdict::not_confirmed:
      return "observable; does not explain the held-out part better: left as given";
    case Verdict::kept:
      break;
  }
  std::snprintf(text.data(), text.size(), "observable; kept, as %.5g +- %.3g with the others as written",
                found.kept_value / unit, 1.96 * found.kept_sigma / unit);
  return text.data();
}

void print_constant(const ConstantFound& found) {
  const double unit = found.constant.unit, half = 1.96 * found.sigma / unit;
  const std::string sensor = found.constant.sensor > 0 ? " (sensor " + std::to_string(found.constant.sensor) + ")" : "";
  std::printf("%-20s given %9.5g  found %9.5g +- %-8.3g  %s\n", (found.constant.key + sensor).c_str(),
              found.told / unit, found.value / unit, half, verdict_on(found).c_str());
}

void print_constants(const Calibration& found) {
  if (found.constants.empty()) {
    std::printf(
        "not estimated for such a log: scale and bias of the odometry, heading and place of the sensors, delay\n");
    return;
  }
  for (const ConstantFound& constant : found.constants) print_constant(constant);
  std::printf(
      "held-out test, each quarter of the scans with what is kept fitted to the others: ln L %+.1f; NIS per degree of "
      "freedom of the last quarter: %.3f as given, %.3f as kept\n",
      found.held_out_gain, found.nis_told, found.nis_found);
}

void print_result(const Calibration& result) {
  print_scale("odometry", result.scales.odometry);
  print_scale("detections", result.scales.landmarks);
  print_constants(result);
  if (result.undetermined > 0) {
    std::printf("left out, since bearings from nearly one side leave open where they stand: %d landmarks\n",
                result.undetermined);
  }
  if (result.slips > 0) {
    std::printf("left out of the noise of the odometry: %zu %s of the vehicle, as the landmarks say\n", result.slips,
                result.slips == 1 ? "slip" : "slips");
  }
  if (!result.settled) std::printf("not settled after %d rounds: do not trust the intervals\n", result.rounds);
  if (result.without_returns) {
    std::printf(
        "the returns of this drive do not fit the rest of it, and are not used: associations may be wrong, or the "
        "odometry\nslipped where the landmarks do not show it\n");
  }
  if (result.closings < result.first_closings) {
    std::printf(
        "warning: with what was found %zu loops are closed, with what was assumed %zu; see in the report which were "
        "right\n"
        "before you keep it\n",
        result.closings, result.first_closings);
  }
}

std::string factor_text(const smoothing::NoiseScale& scale) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", scale.factor);
  return text;
}

/// Constants that differ from the file by more than ten times what files are usually off by are wrong associations: bearings
/// stretched by a factor settled at a lever arm of 8.4 m for 0.5 m.
void refuse_what_no_file_has(const std::string& out, const Calibration& result) {
  constexpr double most_usual = 10.0;
  for (const ConstantFound& found : result.constants) {
    const double way = std::abs(found.kept_value - found.told);
    if (!found.kept() || way <= most_usual * found.constant.usual) continue;
    std::fflush(stdout);
    throw core::InputError(out + ": not written, since " + found.constant.key +
                           " would be farther from the given value than any vehicle file is wrong by: associations or "
                           "what the vehicle file says are far off; see to mounting, units and signs first ('helixnav "
                           "check')");
  }
}

/// If it has not settled and either leaves out more than a quarter of the detections or finds more than four times the assumed noise,
/// it is not a calibration; if most are used it is one, and the file states that it has not settled.
void write_out(const std::string& out, const logs::Vehicle& vehicle, const Calibration& result) {
  refuse_what_no_file_has(out, result);
  constexpr double most_noise = 4.0;
  const bool is_noise = std::max(result.scales.odometry.factor, result.scales.landmarks.factor) > most_noise;
  if (!result.settled && (is_noise || 4 * result.used < 3 * result.observations)) {
    std::fflush(stdout);
    throw core::InputError(
        out + ": not written, since nothing settled after " + std::to_string(result.rounds) + " rounds, and of " +
        std::to_string(result.observations) + " detections " + std::to_string(result.used) +
        " are used, with noise x " + factor_text(result.scales.odometry) + " of the odometry and x " +
        factor_text(result.scales.landmarks) +
        " of the detections: associations or what the vehicle file says are far off; see to mounting, units, "
        "signs and gaps first ('helixnav check')");
  }
  const std::string head = result.settled ? "" : "# calibrate had not settled: do not trust the intervals\n";
  files::write_whole_file(out, head + calibrated_text(vehicle, result));
  std::printf("written: %s\n", out.c_str());
}

ExitCode calibrate(CLI::App& command, CalibrateJob& job) {
  const GivenOptions given = options_given(command);
  if (!job.config.empty()) apply_config_file(command, job.config);
  require_compressed_ekf(command, given, job.settings.fastslam, "calibrate judges noise by the compressed EKF");
  refuse_memory_limit(job.settings, "calibrate judges whole drives");
  refuse_noise_beside_file(given);
  if (logs::is_mrclam(job.path)) throw core::InputError(job.path + ": a log of several robots; calibrate reads one");
  warn_of_deprecated_keys(command);
  apply_vehicle(command, job.vehicle, job.path, job.settings);
  const logs::Vehicle vehicle = vehicle_of(job);
  if (!job.out.empty() && std::filesystem::exists(job.out)) {
    throw core::InputError(job.out + ": is there already; choose another --out");
  }
  if (!job.out.empty()) files::check_writable(job.out);
  const Calibration result = calibrate_log(job.path, job.settings, vehicle);
  print_result(result);
  if (!job.out.empty()) write_out(job.out, vehicle, result);
  return ExitCode::ok;
}

ExitCode calibrate_until_interrupted(CLI::App& command, CalibrateJob& job) {
  catch_interrupts();
  try {
    return calibrate(command, job);
  } catch (const Interrupted&) {
    std::fprintf(stderr, "helixnav: interrupted; nothing is written\n");
    return ExitCode::interrupted;
  }
}

}  // namespace

void add_calibrate_command(CLI::App& app, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("calibrate", "Estimate noise, scales, biases, mounting and delay from a log, without truth");
  const auto job = std::make_shared<CalibrateJob>();
  command->add_option("PATH", job->path, "Log: file, folder or zip; the format is recognised")->required();
  add_vehicle_option(*command, job->vehicle);
  command->add_option("--out", job->out, "Write the vehicle with what was found, everything else as it is")
      ->type_name("FILE");
  command->add_option("--config", job->config, "INI or TOML file of the settings (helixnav config --dump)")
      ->type_name("FILE");
  add_settings(*command, job->settings);
  command->footer(
      "Navigates the log, solves the whole drive, fits the constants of the vehicle file and both noises to it, and\n"
      "repeats this with the result until it settles. A constant is kept where its 95 % interval excludes the given\n"
      "value and where, fitted to three quarters of the log, it explains the fourth better. Others are left as given\n"
      "and the rest is estimated again; so is a constant that the log says too little about or that does not settle.\n"
      "Noise goes into vehicle.toml as noise_scale. For a published log it begins with the vehicle that ships. What\n"
      "does not settle and leaves out more than a quarter of the detections, or asks for four times the noise, is\n"
      "printed, not written (exit code 3); nor is what is ten times farther off than vehicle files usually are.\n\n"
      "Examples:\n"
      "  helixnav calibrate my_drive --out calibrated.toml\n"
      "  helixnav replay my_drive --vehicle calibrated.toml --out runs/calibrated\n"
      "  helixnav calibrate victoria_park_ascii.zip --out truck.toml\n");
  command->callback([command, job, &code] { code = calibrate_until_interrupted(*command, *job); });
}

}  // namespace helixnav::apps
