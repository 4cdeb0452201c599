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
#include "keep_scans.hpp"
#include "replay/read_to_replay.hpp"
#include "settings/vehicle_option.hpp"
#include "settled_log.hpp"
#include "slipped_scans.hpp"
#include "stop_if_interrupted.hpp"

namespace helixnav::apps {
namespace {

double squared(double value) { return value * value; }
void multiply(smoothing::NoiseScale& scale, const smoothing::NoiseScale& more) {
  scale.low_95 = scale.factor * more.low_95;
  scale.high_95 = scale.factor * more.high_95;
  scale.factor *= more.factor;
  scale.redundancy = more.redundancy;
}

/// A first drive with constants that are wrong makes wrong associations, and these ask for any noise: no more than twice as
/// much in a round.
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
      result_.constants.push_back(
          {constant, constant.value(settings), constant.value(settings), 0.0, false, false, 0.0});
    }
  }

  Calibration run() {
    constexpr int most_rounds = 8;
    while (result_.rounds < most_rounds && !result_.settled) round();
    if (!constants_.empty()) judge();
    return result_;
  }

 private:
  /// As replay refuses it, and where bearings or turns have the other sign: what fits then are wrong associations.
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

  /// The log of a drive, whose associations are cut to the scans of which the odometry still says where they were taken: another
  /// delay puts others behind its end.
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

  /// Steering of a log without steering, turns of a log with it.
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
    // Gates cut the tails that noise is judged by: that of a pair, and that of all pairs of a scan together.
    options.gates.match_probability = options.association.joint_probability = 0.9999;
    options.gates.new_probability = 0.999999;
    return drive_through(recording, options, settings.known_association);
  }

  struct Fit {
    double step = 0.0;  ///< of the constant that went farthest, in its standard deviations
    smoothing::NoiseScales noise;

    double most_noise() const { return std::max(noise.odometry.factor, noise.landmarks.factor); }
  };

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
    constexpr double settled = 0.02, settled_sigmas = 0.4, far_sigmas = 3.0;  // a match or two go to and fro
    const bool final_associations = !far_off_;
    far_off_ = fit.step > far_sigmas;
    // Away again from where the fit without returns is, and back: the returns contradict the rest, and would for ever.
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
  }

  /// Without returns where they cannot be believed: the constants may be far off, or the returns fit the rest so badly that they
  /// ask for half as much noise again or cannot be solved.
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

  Eigen::VectorXd usual() const {
    Eigen::VectorXd usual(index(constants_.size()));
    for (std::size_t c = 0; c < constants_.size(); ++c) usual[index(c)] = constants_[c].usual;
    return usual;
  }

  /// Back to what was told.
  Eigen::VectorXd back(const Settings& settings) const {
    Eigen::VectorXd change(index(constants_.size()));
    for (std::size_t c = 0; c < constants_.size(); ++c)
      change[index(c)] = result_.constants[c].told - constants_[c].value(settings);
    return change;
  }

  NudgedLog nudged(const core::Recording& recording) const {
    return nudge([this](const Settings& settings) { return plain(settings); }, result_.settings, constants_, recording);
  }

  /// Gauss–Newton with the associations of the drive, which is left solved with what was found. How far it went, in standard
  /// deviations of the constant that went farthest.
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
      const std::vector<bool> free = observable(evidence.information, usual());
      sigmas = sigmas_of(evidence.information, free, usual());
      const double step = move(best_change(evidence, free, back(result_.settings)), free, sigmas);
      constexpr double little = 0.02;
      if (step < little) break;
    }
    const core::Recording recording = read_of(drive);
    drive.task = solve_log(recording, drive.ids, drive.task.problem.graph);
    double went = 0.0;
    for (std::size_t c = 0; c < constants_.size(); ++c) {
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
      found.value = to;
      found.sigma = sigmas[index(c)];
      found.observable = free[c];
      longest = std::max(longest, std::abs(to - value) / found.sigma);
    }
    return longest;
  }

  /// Evidence of the scans of one part of the log, or of all others, the observations of the rest being left out.
  smoothing::ConstantsEvidence evidence_of(const core::Recording& recording, const NudgedLog& log, int part,
                                           bool inside) const {
    Ids ids = ids_;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const bool is_inside = static_cast<int>(k * std::size_t{parts_held_out} / ids.size()) == part;
      if (is_inside != inside) std::fill(ids[k].begin(), ids[k].end(), core::no_label);
    }
    const SmoothingTask task = solve_log(recording, ids, graph_);
    return smoothing::evidence_of_constants(task.problem, derivatives_of(log, task));
  }

  /// Observable in the whole log and without any of its parts.
  std::vector<bool> free_in(const std::vector<Fold>& folds) const {
    std::vector<bool> free;
    for (const ConstantFound& found : result_.constants) free.push_back(found.observable);
    for (const Fold& fold : folds) {
      const std::vector<bool> without_part = observable(fold.rest.information, usual());
      for (std::size_t c = 0; c < free.size(); ++c) free[c] = free[c] && without_part[c];
    }
    return free;
  }

  /// Keeps what, fitted to three quarters of the drive, explains the fourth better than what was told; by the whole then.
  void judge() {
    core::Recording recording = read(result_.settings);
    loosen_odometry(slipped_, recording);
    const NudgedLog log = nudged(recording);
    std::vector<Fold> folds;
    ProgressBar progress("judging by what is held out", parts_held_out + 1, false);
    for (int part = 0; part < parts_held_out; ++part) {
      progress.advance_to(static_cast<std::size_t>(part));
      folds.push_back({evidence_of(recording, log, part, false), evidence_of(recording, log, part, true)});
    }
    const auto all = evidence_of(recording, log, parts_held_out, false);
    const Eigen::VectorXd told = back(result_.settings);
    const std::vector<bool> none(constants_.size(), false);
    const std::vector<bool> keep = confirmed(folds, free_in(folds), told);
    result_.held_out_gain = 0.5 * (held_out_chi2(folds, none, told) - held_out_chi2(folds, keep, told));
    result_.nis_told = nis_held_out(known_);
    result_.nis_found = nis_held_out(changed(best_change(folds.back().rest, keep, told)));
    result_.settings = changed(best_change(all, keep, told));
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      result_.constants[c].kept = keep[c];
      result_.constants[c].kept_value = constants_[c].value(result_.settings);
    }
  }

  Settings changed(const Eigen::VectorXd& change) const {
    Settings settings = result_.settings;
    for (std::size_t c = 0; c < constants_.size(); ++c) constants_[c].add(settings, change[index(c)]);
    return settings;
  }

  /// Not a number where a run breaks off, as one may with the noise found and constants that are wrong.
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
  std::size_t scans_ = every_scan;  ///< of the log that are used: the same ones in all of a round
  std::vector<VehicleConstant> constants_;
  bool far_off_;                      ///< the constants may be, so that returns cannot be believed
  int times_thrown_back_ = 0;         ///< far off after they were not
  Ids ids_;                           ///< of the last round
  std::vector<std::size_t> slipped_;  ///< likewise
  core::LandmarkGraph graph_;         ///< solved with them
  Calibration result_;
};

}  // namespace

Calibration calibrate_log(const std::string& path, const Settings& settings, const logs::Vehicle& vehicle) {
  return Calibrator(path, settings, vehicle).run();
}

}  // namespace helixnav::apps
