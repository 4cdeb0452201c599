// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/config_file.hpp"
#include "common/fit_to_recording.hpp"
#include "common/settings.hpp"
#include "common/vehicle_option.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/logs/shipped_vehicle.hpp"
#include "helixnav/smoothing/noise_scales.hpp"
#include "replay/read_to_replay.hpp"
#include "settled_drive.hpp"
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

struct Calibration {
  smoothing::NoiseScales scales;   ///< on what the vehicle file assumes
  SettledDrive drive;              ///< with them
  std::size_t first_closings = 0;  ///< of the run with the assumed noise
  int rounds = 0;
  bool settled = false;
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

/// Noise stated beside the vehicle file would make the factors those of another noise than the file's.
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

double squared(double value) { return value * value; }

void multiply(smoothing::NoiseScale& scale, const smoothing::NoiseScale& more) {
  scale.low_95 = scale.factor * more.low_95;
  scale.high_95 = scale.factor * more.high_95;
  scale.factor *= more.factor;
  scale.redundancy = more.redundancy;
}

/// Navigates with the noise as known, corrects it by the residuals, and again until nothing changes.
Calibration calibrate_noise(CalibrateJob& job) {
  constexpr int most_rounds = 8;
  constexpr double settled = 0.01;
  core::Recording log = read_to_replay(job.path, job.settings).recording;
  print_remarks(log);
  apply_log_settings(log, job.settings);
  Calibration result;
  while (result.rounds < most_rounds && !result.settled) {
    core::Recording recording = log;
    scale_covariances(recording, squared(result.scales.odometry.factor), squared(result.scales.landmarks.factor));
    supervisor::NavigatorOptions options = fit_to_recording(job.settings, recording);
    options.gates.match_probability = 0.9999;  // a gate cuts the tails that noise is judged by
    options.gates.new_probability = 0.999999;
    result.drive = settle(recording, options, job.settings.known_association);
    const smoothing::NoiseScales step = smoothing::estimate_noise_scales(result.drive.problem, 1);
    multiply(result.scales.odometry, step.odometry);
    multiply(result.scales.landmarks, step.landmarks);
    if (result.rounds == 0) result.first_closings = result.drive.closings;
    ++result.rounds;
    result.settled =
        std::abs(std::log(step.odometry.factor)) < settled && std::abs(std::log(step.landmarks.factor)) < settled;
    std::printf("round %d: odometry x %.3f, detections x %.3f, NIS %.3f, %zu closings, %zu of %zu detections used\n",
                result.rounds, result.scales.odometry.factor, result.scales.landmarks.factor, result.drive.nis_per_dof,
                result.drive.closings, result.drive.used, result.drive.observations);
    std::fflush(stdout);
  }
  return result;
}

void print_scale(const char* what, const smoothing::NoiseScale& scale) {
  const double factor = scale.factor;
  std::printf("%-11s noise x %.3f (95 %%: %.3f to %.3f; judged by %.0f residuals): %s than assumed\n", what, factor,
              scale.low_95, scale.high_95, scale.redundancy,
              scale.low_95 <= 1.0 && scale.high_95 >= 1.0 ? "not different"
              : factor > 1.0                              ? "worse"
                                                          : "better");
}

ExitCode calibrate(CLI::App& command, CalibrateJob& job) {
  const GivenOptions given = options_given(command);
  if (!job.config.empty()) apply_config_file(command, job.config);
  require_compressed_ekf(command, given, job.settings.fastslam, "calibrate judges noise by the compressed EKF");
  refuse_noise_beside_file(given);
  if (logs::is_mrclam(job.path)) throw core::InputError(job.path + ": a log of several robots; calibrate reads one");
  apply_vehicle(command, job.vehicle, job.path, job.settings);
  const logs::Vehicle vehicle = vehicle_of(job);
  if (!job.out.empty() && std::filesystem::exists(job.out)) {
    throw core::InputError(job.out + ": is there already; choose another --out");
  }
  const Calibration result = calibrate_noise(job);
  print_scale("odometry", result.scales.odometry);
  print_scale("detections", result.scales.landmarks);
  std::printf("not estimated: scale and bias of the odometry, heading and place of the sensors, delay\n");
  if (!result.settled) std::printf("not settled after %d rounds: the intervals are not to be trusted\n", result.rounds);
  if (result.drive.closings < result.first_closings) {
    std::printf(
        "warning: with this noise %zu loops are closed, with the assumed noise %zu: the odometry is off by something\n"
        "that is no white noise, as a scale or a bias of its turns; mend that first, and keep the assumed noise\n",
        result.drive.closings, result.first_closings);
  }
  if (job.out.empty()) return ExitCode::ok;
  std::ofstream file(job.out);
  file << with_noise_scales(vehicle, result.scales);
  file.close();
  if (!file) throw core::InputError(job.out + ": cannot be written");
  std::printf("written: %s\n", job.out.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_calibrate_command(CLI::App& app, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("calibrate", "Estimate the noise of odometry and detections from a log, without truth");
  const auto job = std::make_shared<CalibrateJob>();
  command->add_option("PATH", job->path, "Log: file, folder or zip; the format is recognised")->required();
  add_vehicle_option(*command, job->vehicle);
  command->add_option("--out", job->out, "Write the vehicle with the noise found, everything else as it is")
      ->type_name("FILE");
  command->add_option("--config", job->config, "INI or TOML file of the settings (helixnav config --dump)")
      ->type_name("FILE");
  add_settings(*command, job->settings);
  command->footer(
      "Navigates the log and judges both noises by what is left when the drive is solved as a whole; then again with "
      "the\n"
      "noise found, until it stays. The factors go into vehicle.toml as noise_scale. Of a published log it begins with "
      "the\n"
      "vehicle that ships. Scales, biases, mountings and delays are not estimated.\n\n"
      "Examples:\n"
      "  helixnav calibrate my_drive --out calibrated.toml\n"
      "  helixnav replay my_drive --vehicle calibrated.toml --out runs/calibrated\n"
      "  helixnav calibrate victoria_park_ascii.zip --out truck.toml\n");
  command->callback([command, job, &code] { code = calibrate(*command, *job); });
}

}  // namespace helixnav::apps
