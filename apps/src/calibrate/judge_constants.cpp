// SPDX-License-Identifier: BSD-3-Clause
#include "judge_constants.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/progress_bar.hpp"
#include "keep_scans.hpp"
#include "slipped_scans.hpp"

namespace helixnav::apps {
namespace {

class Judge {
 public:
  Judge(JudgedDrive drive, Calibration& calibration) : drive_(std::move(drive)), result_(calibration) {
    for (const ConstantFound& found : result_.constants) constants_.push_back(found.constant);
  }

  Settings run() {
    const Settings found = result_.settings;
    const std::vector<Fold> folds = cut();
    const auto all = evidence_here();
    const Eigen::VectorXd told = back_to_told(result_, found);
    std::vector<Verdict> verdicts = judge_kept(all, folds, free_in(folds), usual_of(result_), told);
    change(best_change(all, kept_of(verdicts), told));
    estimate(verdicts);
    if (drop_what_gains_nothing(verdicts)) {
      change(best_change(evidence_here(), kept_of(verdicts), back_to_told(result_, result_.settings)));
      estimate(verdicts);
    }
    const std::vector<bool> none(constants_.size(), false), keep = kept_of(verdicts);
    result_.held_out_gain = 0.5 * (held_out_chi2(folds, none, told) - held_out_chi2(folds, keep, told));
    Settings by_rest = found;
    change(by_rest, best_change(folds.back().rest, keep, told));
    return by_rest;
  }

 private:
  core::Recording recording_of(const Settings& settings) const {
    core::Recording recording = drive_.with_noise_found(settings);
    loosen_odometry(drive_.slipped, recording);
    return recording;
  }
  core::Recording recording_here() const { return recording_of(result_.settings); }

  NudgedLog nudged(const core::Recording& recording) const {
    return nudge(drive_.as_told, result_.settings, constants_, recording);
  }

  std::vector<Fold> cut() const {
    const core::Recording recording = recording_here();
    const NudgedLog log = nudged(recording);
    std::vector<Fold> folds;
    ProgressBar progress("judging by what is held out", parts_held_out + 1, false);
    for (int part = 0; part < parts_held_out; ++part) {
      progress.advance_to(static_cast<std::size_t>(part));
      folds.push_back({evidence_of(recording, log, part, false), evidence_of(recording, log, part, true)});
    }
    return folds;
  }

  /// Evidence from the scans of one part of the log, or of all others, with the observations of the rest left out.
  smoothing::ConstantsEvidence evidence_of(const core::Recording& recording, const NudgedLog& log, int part,
                                           bool inside) const {
    Ids ids = drive_.ids;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const bool is_inside = static_cast<int>(k * std::size_t{parts_held_out} / ids.size()) == part;
      if (is_inside != inside) std::fill(ids[k].begin(), ids[k].end(), core::no_label);
    }
    const SmoothingTask task = solve_log(recording, ids, drive_.graph);
    return smoothing::evidence_of_constants(task.problem, derivatives_of(log, task));
  }

  /// Of the whole log; another delay may put the last scans after its end.
  smoothing::ConstantsEvidence evidence_here() {
    const core::Recording recording = recording_here();
    if (const std::size_t scans = scans_of(recording); drive_.ids.size() > scans) drive_.ids.resize(scans);
    return evidence_of(recording, nudged(recording), parts_held_out, false);
  }

  /// Kept until judged: those that differ from the file values with all others free, and are observable without any one part of
  /// the log, too. With others at their file values an interval is narrower, and for a log that the model does not quite fit it
  /// then excludes the truth.
  std::vector<Verdict> free_in(const std::vector<Fold>& folds) const {
    std::vector<Verdict> verdicts;
    for (const ConstantFound& found : result_.constants) {
      const bool free = found.observable && found.verdict != Verdict::unsettled;
      const bool differs = std::abs(found.value - found.told) > 1.96 * found.sigma;
      verdicts.push_back(!free ? found.verdict : differs ? Verdict::kept : Verdict::indistinguishable);
    }
    for (const Fold& fold : folds) {
      const std::vector<bool> without_part = observable(fold.rest.information, usual_of(result_));
      for (std::size_t c = 0; c < verdicts.size(); ++c) {
        if (verdicts[c] == Verdict::kept && !without_part[c]) verdicts[c] = Verdict::not_confirmed;
      }
    }
    return verdicts;
  }

  /// The kept ones, with all else at file values; those that then do not differ from their file values go back, too.
  void estimate(std::vector<Verdict>& verdicts) {
    Eigen::VectorXd sigmas = Eigen::VectorXd::Zero(index(constants_.size()));
    constexpr int most_steps = 4;
    constexpr double little = 0.02;
    for (int i = 0; i < most_steps && is_any_kept(verdicts); ++i) {
      const auto evidence = evidence_here();
      const Eigen::VectorXd usual = usual_of(result_), told = back_to_told(result_, result_.settings);
      while (const auto least = least_significant(evidence, verdicts, usual, told))
        verdicts[*least] = Verdict::indistinguishable;
      const Eigen::VectorXd step = best_change(evidence, kept_of(verdicts), told);
      sigmas = kept_sigmas(evidence.information, verdicts, usual);
      change(step);
      if ((step.array().abs() <= little * sigmas.array()).all()) break;
    }
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      ConstantFound& found = result_.constants[c];
      found.verdict = verdicts[c];
      found.kept_value = constants_[c].value(result_.settings);
      found.kept_sigma = found.kept() ? sigmas[index(c)] : 0.0;
    }
  }

  /// χ² of the first scans of a log, solved.
  double solved_chi2(core::Recording recording, std::size_t scans) const {
    keep_scans(recording, scans);
    Ids ids = drive_.ids;
    ids.resize(scans);
    return smoothing::evaluate_chi2(solve_log(recording, ids, drive_.graph).problem).total();
  }

  /// What a delay gains when the log is read with it and solved, beside what its derivative promises. The derivative is taken from
  /// solved speeds, and on long straights their noise is most of what changes: of 76 logs without any delay, 33 had one by the
  /// derivative alone, and the log read with it had no smaller χ². True delays gain as much as promised, and more.
  bool drop_what_gains_nothing(std::vector<Verdict>& verdicts) {
    bool dropped = false;
    for (std::size_t c = 0; c < constants_.size(); ++c) {
      const ConstantFound& found = result_.constants[c];
      if (verdicts[c] != Verdict::kept || constants_[c].nudge > 0.0) continue;
      Settings without = result_.settings;
      constants_[c].add(without, found.told - found.kept_value);
      const core::Recording with_it = recording_here(), without_it = recording_of(without);
      const std::size_t scans = std::min({scans_of(with_it), scans_of(without_it), drive_.ids.size()});
      const double sigmas = (found.kept_value - found.told) / found.kept_sigma;
      if (gains_as_promised(solved_chi2(without_it, scans) - solved_chi2(with_it, scans), sigmas)) continue;
      verdicts[c] = Verdict::not_confirmed;
      dropped = true;
    }
    return dropped;
  }

  void change(const Eigen::VectorXd& by) { change(result_.settings, by); }
  void change(Settings& settings, const Eigen::VectorXd& by) const {
    for (std::size_t c = 0; c < constants_.size(); ++c) constants_[c].add(settings, by[index(c)]);
  }

  JudgedDrive drive_;
  Calibration& result_;
  std::vector<VehicleConstant> constants_;
};

}  // namespace

Eigen::VectorXd usual_of(const Calibration& calibration) {
  Eigen::VectorXd usual(index(calibration.constants.size()));
  for (std::size_t c = 0; c < calibration.constants.size(); ++c) {
    const ConstantFound& found = calibration.constants[c];
    usual[index(c)] = found.verdict == Verdict::unsettled ? 0.0 : found.constant.usual;
  }
  return usual;
}

Eigen::VectorXd back_to_told(const Calibration& calibration, const Settings& settings) {
  Eigen::VectorXd change(index(calibration.constants.size()));
  for (std::size_t c = 0; c < calibration.constants.size(); ++c) {
    const ConstantFound& found = calibration.constants[c];
    change[index(c)] = found.told - found.constant.value(settings);
  }
  return change;
}

Settings judge_constants(JudgedDrive drive, Calibration& calibration) {
  return Judge(std::move(drive), calibration).run();
}

}  // namespace helixnav::apps
