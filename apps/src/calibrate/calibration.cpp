// SPDX-License-Identifier: BSD-3-Clause
#include "calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "common/fit_to_recording.hpp"
#include "common/progress_bar.hpp"
#include "constants_fit.hpp"
#include "drive/check_drive.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/handedness.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "judge_constants.hpp"
#include "keep_scans.hpp"
#include "replay/read_to_replay.hpp"
#include "settings/vehicle_option.hpp"
#include "settled_log.hpp"
#include "slipped_scans.hpp"
#include "stop_if_interrupted.hpp"
#include "swings.hpp"

namespace helixnav::apps {
namespace {

double squared(double value) { return value * value; }
void multiply(smoothing::NoiseScale& scale, const smoothing::NoiseScale& more) {
  scale.low_95 = scale.factor * more.low_95;
  scale.high_95 = scale.factor * more.high_95;
  scale.factor *= more.factor;
  scale.redundancy = more.redundancy;
}

/// A first drive with wrong constants makes wrong associations, and these call for any amount of noise: at most twice as much
/// per round.
void limit(smoothing::NoiseScale& scale) {
  constexpr double most = 2.0;
  if (scale.factor <= most) return;
  scale.low_95 *= most / scale.factor;
  scale.high_95 *= most / scale.factor;
  scale.factor = most;
}

/// The work of calibrate_log.
class Calibrator {
 public:
  Calibrator(std::string path, const Settings& settings, const logs::Vehicle& vehicle)
      : path_(std::move(path)), known_(settings) {
    result_.settings = settings;
    const core::Recording log = plain(settings);
    print_remarks(log);
    check(log);
    const double reach_m = logs::field_of_view_of(log).reach().value_or(supervisor::reference_reach_m);
    constants_ = constants_of(settings, logs::recognise(path_), vehicle, reach_m);
    drop_what_does_nothing(log);
    far_off_ = !constants_.empty();
    for (const VehicleConstant& constant : constants_) {
      ConstantFound& found = result_.constants.emplace_back();
      found.constant = constant;
      found.told = found.value = found.kept_value = constant.value(settings);
    }
  }

  Calibration run() {
    constexpr int most_rounds = 8, most_with_fewer = 12;
    while (result_.rounds < (leaves_any() ? most_with_fewer : most_rounds) && !result_.settled) {
      try_round();
      if (!result_.settled && repeats(values_, sigmas())) leave_least_significant();
    }
    if (!result_.settled) leave_unsettled();
    if (!constants_.empty()) judge();
    return result_;
  }

 private:
  /// Refuses what replay refuses, and bearings or turns of the opposite sign: what then fits is wrong associations.
  void check(const core::Recording& log) const {
    Drive drive;
    drive.recording = log;
    drive.known_association = known_.known_association;
    check_drive(drive);
    if (const std::optional<std::string> doubt = logs::doubt_handedness(log)) {
      throw core::InputError(path_ + ": no constant mends a sign: " + *doubt);
    }
  }

  core::Recording plain(const Settings& settings) const {
    stop_if_interrupted();
    Settings copy = settings;
    core::Recording log = read_to_replay(path_, copy).recording;
    apply_log_settings(log, copy);
    keep_scans(log, scans_);
    return log;
  }

  /// The log of a drive, whose associations are cut to the scans that the odometry still covers: another delay puts others after
  /// its end.
  core::Recording read_of(SettledDrive& drive) {
    core::Recording log = read(result_.settings);
    loosen_odometry(drive.slipped, log);
    scans_ = scans_of(log);
    if (drive.ids.size() > scans_) drive.ids.resize(scans_);
    return log;
  }

  core::Recording read(const Settings& settings) const {
    core::Recording log = plain(settings);
    scale_covariances(log, squared(result_.scales.odometry.factor), squared(result_.scales.landmarks.factor));
    return log;
  }

  /// Steering for a log without steering, turns for a log with it.
  void drop_what_does_nothing(const core::Recording& log) {
    const auto reader = [this](const Settings& settings) { return plain(settings); };
    const NudgedLog nudged = nudge(reader, result_.settings, constants_, log);
    std::vector<VehicleConstant> kept;
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      if (!same(nudged.told, nudged.nudged[c])) kept.push_back(constants_[c]);
    }
    constants_ = kept;
  }

  SettledDrive navigate(const Settings& settings) const {
    const core::Recording recording = read(settings);
    supervisor::NavigatorOptions options = fit_to_recording(settings, recording);
    // Gates cut off the tails by which noise is judged: that of a pair, and the joint one of all pairs of a scan.
    options.gates.match_probability = options.association.joint_probability = 0.9999;
    options.gates.new_probability = 0.999999;
    return drive_through(recording, options, settings.known_association);
  }

  struct Fit {
    double step = 0.0;  ///< of the constant that moved farthest, in its standard deviations
    smoothing::NoiseScales noise;

    double most_noise() const { return std::max(noise.odometry.factor, noise.landmarks.factor); }
  };

  /// A log with too little in it determines no drive at all.
  void try_round() {
    try {
      round();
    } catch (const core::NumericalError& error) {
      throw core::InputError(path_ + ": the log does not determine the drive (" + error.what() + "); after " +
                             std::to_string(result_.rounds) + " rounds, " + std::to_string(result_.used) + " of " +
                             std::to_string(result_.observations) +
                             " detections were used: it takes a longer log, or more landmarks in view");
    }
  }

  void round() {
    scans_ = every_scan;
    SettledDrive drive = navigate(result_.settings);
    scans_ = drive.ids.size();
    const Fit fit = fit_to(drive);
    multiply(result_.scales.odometry, fit.noise.odometry);
    multiply(result_.scales.landmarks, fit.noise.landmarks);
    if (result_.rounds == 0) result_.first_closings = drive.closings;
    result_.closings = drive.closings;
    result_.observations = drive.observations;
    result_.used = drive.used;
    result_.slips = count_slips(drive.slipped);
    result_.undetermined = drive.task.undetermined_landmarks;
    ++result_.rounds;
    constexpr double settled = 0.02, settled_sigmas = 0.4, far_sigmas = 3.0;  // a match or two alternate
    const bool final_associations = !far_off_;
    far_off_ = fit.step > far_sigmas;
    // Away again from the fit without returns, and back: the returns contradict the rest, and always would.
    if (final_associations && far_off_ && ++times_thrown_back_ > 1) result_.without_returns = true;
    result_.settled = final_associations && std::abs(std::log(fit.noise.odometry.factor)) < settled &&
                      std::abs(std::log(fit.noise.landmarks.factor)) < settled && fit.step < settled_sigmas;
    std::printf(
        "round %d: odometry x %.3f, detections x %.3f, constants moved by %.2f of their standard deviations, "
        "NIS %.3f, %zu closings, %zu of %zu detections used\n",
        result_.rounds, result_.scales.odometry.factor, result_.scales.landmarks.factor, fit.step, drive.nis_per_dof,
        drive.closings, drive.used, drive.observations);
    std::fflush(stdout);
    ids_ = std::move(drive.ids);
    slipped_ = std::move(drive.slipped);
    graph_ = std::move(drive.task.problem.graph);
    values_.push_back(values());
  }

  Eigen::VectorXd values() const {
    Eigen::VectorXd values(index(constants_.size()));
    for (std::size_t c = 0; c < constants_.size(); ++c) values[index(c)] = constants_[c].value(result_.settings);
    return values;
  }

  Eigen::VectorXd sigmas() const {
    Eigen::VectorXd sigmas(index(constants_.size()));
    for (std::size_t c = 0; c < constants_.size(); ++c)
      sigmas[index(c)] = is_left(c) ? 0.0 : result_.constants[c].sigma;
    return sigmas;
  }

  /// Left at its file value from here on.
  bool is_left(std::size_t c) const { return result_.constants[c].verdict == Verdict::unsettled; }
  bool leaves_any() const {
    return std::any_of(result_.constants.begin(), result_.constants.end(),
                       [](const ConstantFound& found) { return found.verdict == Verdict::unsettled; });
  }

  /// Rounds that repeat never settle: of the constants that oscillate, the one nearest to its file value goes back to it, and
  /// the rounds are counted anew.
  void leave_least_significant() {
    const Eigen::VectorXd swing = swings(values_, sigmas());
    constexpr double settled_sigmas = 0.4;
    ConstantFound* least = nullptr;
    const auto significance = [](const ConstantFound& found) {
      return std::abs(found.value - found.told) / found.sigma;
    };
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      ConstantFound& found = result_.constants[c];
      if (is_left(c) || !found.observable || swing[index(c)] < settled_sigmas) continue;
      if (least == nullptr || significance(found) < significance(*least)) least = &found;
    }
    if (least == nullptr) return;
    least->verdict = Verdict::unsettled;
    least->constant.add(result_.settings, least->told - least->constant.value(result_.settings));
    std::printf("the rounds repeat: %s is left as given\n", least->constant.key.c_str());
    values_.clear();
  }

  /// The constants that still swing by more than their intervals.
  void leave_unsettled() {
    if (values_.size() < 2) return;
    const Eigen::VectorXd swing = swings(values_, sigmas());
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      if (result_.constants[c].observable && swing[index(c)] > 1.96) result_.constants[c].verdict = Verdict::unsettled;
    }
  }

  /// Without returns if they cannot be trusted: the constants may be far off, or the returns fit the rest so badly that they
  /// call for half as much noise again or cannot be solved.
  Fit fit_to(SettledDrive& drive) {
    if (constants_.empty()) return fit_all(drive);
    if (!far_off_ && !result_.without_returns) {
      constexpr double too_much = 1.5;
      const SettledDrive as_driven = drive;
      const Calibration before = result_;
      try {
        const Fit fit = fit_all(drive);
        if (fit.most_noise() < too_much) return fit;
      } catch (const core::NumericalError&) {
      }
      drive = as_driven;
      result_ = before;
      result_.without_returns = true;
    }
    drive.ids = without_returns(drive.ids);
    return fit_all(drive);
  }

  Fit fit_all(SettledDrive& drive) {
    Fit fit;
    fit.step = fit_constants(drive);
    fit.noise = noise_of(drive);
    limit(fit.noise.odometry);
    limit(fit.noise.landmarks);
    return fit;
  }

  /// A drive that is nonsense from beginning to end leaves nothing to judge noise by.
  smoothing::NoiseScales noise_of(const SettledDrive& drive) const {
    constexpr int draws = 12;
    try {
      return smoothing::estimate_noise_scales(drive.task.problem, 1, draws);
    } catch (const core::NumericalError& error) {
      throw core::InputError(path_ + ": no noise can be judged by this drive (" + error.what() + "), of which " +
                             std::to_string(drive.used) + " of " + std::to_string(drive.observations) +
                             " detections are used: see to the mounting of the sensor (heading_deg), the sign of its "
                             "bearings and the units first; 'helixnav check' shows what was understood");
    }
  }

  NudgedLog nudged(const core::Recording& recording) const {
    return nudge([this](const Settings& settings) { return plain(settings); }, result_.settings, constants_, recording);
  }

  /// Gauss–Newton with the associations of the drive, which is left solved with the result. Returns how far the constant
  /// that moved farthest went, in its standard deviations.
  double fit_constants(SettledDrive& drive) {
    const Settings before = result_.settings;
    Eigen::VectorXd sigmas;
    constexpr int most_steps = 4;
    ProgressBar progress("fitting constants", most_steps, false);
    for (int i = 0; i < most_steps && !constants_.empty(); ++i) {
      progress.advance_to(static_cast<std::size_t>(i));
      const core::Recording recording = read_of(drive);
      if (far_off_ || result_.without_returns) {
        const smoothing::RobustKernel robust{smoothing::RobustKernel::Shape::cauchy};
        drive.task = solve_log(recording, drive.ids, drive.task.problem.graph, robust);
        drive.ids = without_outliers(drive.ids, drive.task);
      }
      drive.task = solve_log(recording, drive.ids, drive.task.problem.graph);
      const auto evidence =
          smoothing::evidence_of_constants(drive.task.problem, derivatives_of(nudged(recording), drive.task));
      const std::vector<bool> free = observable(evidence.information, usual_of(result_));
      sigmas = sigmas_of(evidence.information, free, usual_of(result_));
      const double step = move(best_change(evidence, free, back_to_told(result_, result_.settings)), free, sigmas);
      constexpr double little = 0.02;
      if (step < little) break;
    }
    const core::Recording recording = read_of(drive);
    drive.task = solve_log(recording, drive.ids, drive.task.problem.graph);
    double went = 0.0;
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      if (is_left(c)) continue;
      const double way = constants_[c].value(result_.settings) - constants_[c].value(before);
      went = std::max(went, std::abs(way) / sigmas[index(c)]);
    }
    return went;
  }

  double move(const Eigen::VectorXd& change, const std::vector<bool>& free, const Eigen::VectorXd& sigmas) {
    double longest = 0.0;
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      ConstantFound& found = result_.constants[c];
      const double value = constants_[c].value(result_.settings);
      const double to = std::clamp(value + change[index(c)], constants_[c].least, constants_[c].most);
      constants_[c].add(result_.settings, to - value);
      if (is_left(c)) continue;
      found.value = to;
      found.sigma = sigmas[index(c)];
      found.observable = free[c];
      longest = std::max(longest, std::abs(to - value) / found.sigma);
    }
    return longest;
  }

  void judge() {
    JudgedDrive drive;
    drive.as_told = [this](const Settings& settings) { return plain(settings); };
    drive.with_noise_found = [this](const Settings& settings) { return read(settings); };
    drive.ids = std::move(ids_);
    drive.slipped = std::move(slipped_);
    drive.graph = std::move(graph_);
    const Settings by_rest = judge_constants(std::move(drive), result_);
    result_.nis_told = nis_held_out(known_);
    result_.nis_found = nis_held_out(by_rest);
  }

  /// NaN if a run breaks off, as one may with the noise found and wrong constants.
  double nis_held_out(const Settings& settings) const {
    try {
      return navigate(settings).nis_per_dof_held_out;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "helixnav: note: the run to compare with broke off: %s\n", error.what());
      return std::nan("");
    }
  }

  static constexpr std::size_t every_scan = std::numeric_limits<std::size_t>::max();

  std::string path_;
  Settings known_;
  std::size_t scans_ = every_scan;  ///< of the log that are used: the same ones throughout a round
  std::vector<VehicleConstant> constants_;
  bool far_off_;                      ///< the constants may be, so that returns cannot be trusted
  int times_thrown_back_ = 0;         ///< far off after they were not
  Ids ids_;                           ///< of the last round
  std::vector<std::size_t> slipped_;  ///< likewise
  core::LandmarkGraph graph_;         ///< solved with them
  RoundValues values_;                ///< since rounds began to count
  Calibration result_;
};

}  // namespace

Calibration calibrate_log(const std::string& path, const Settings& settings, const logs::Vehicle& vehicle) {
  return Calibrator(path, settings, vehicle).run();
}

}  // namespace helixnav::apps
