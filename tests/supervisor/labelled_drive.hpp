// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "loop/tape.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {

/// A filter that is told which tree it sees, and its log. Trees of the second half of the drive can be made strangers:
/// they get second ids, which are merged at the end, as after a search. Clutter is mapped and lost again.
class LabelledDrive {
 public:
  enum class Kept { first_name, second_name };

  LabelledDrive(const core::Recording& run, bool strangers, Kept kept = Kept::first_name)
      : run_(run), strangers_(strangers), kept_(kept), filter(run.start), tape(100000) {
    for (const core::Event& event : run.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
        motion_.push_back(*odometry);  // motion after the last scan leads nowhere
        continue;
      }
      predict();
      if (const auto* fix = std::get_if<core::AbsoluteFix>(&event)) {
        tape.append(Tape::Fix{WidenedFix{*fix}, filter.update_position(*fix).nis, true});
      } else {
        see(std::get<core::Scan>(event), run.labels[scans_++]);
      }
    }
    if (strangers_) merge();
  }

  const core::PoseGaussian& start() const { return run_.start; }

  /// Solves the drive in phases of 20 m; the filter becomes the solved one if that was accepted.
  Smoothing solve(const atlas::Options& options = {}) {
    DriveMap map(run_.start, 20.0, options);
    Smoothing smoothing = smooth_drive(filter, tape, map);
    if (smoothing.accepted) filter = filter_at_solution(map, filter);
    return smoothing;
  }

  core::LandmarkId id_of(core::Label label) const { return first_.at(label); }
  const std::map<core::Label, core::LandmarkId>& trees() const { return first_; }

 private:
  void predict() {
    for (const core::Odometry& odometry : motion_) {
      filter.predict(odometry);
      tape.append(Tape::Motion{odometry, 0.0});
    }
    motion_.clear();
  }

  void see(const core::Scan& scan, const std::vector<core::Label>& labels) {
    const bool again = strangers_ && scans_ > run_.labels.size() / 2;
    std::map<core::Label, core::LandmarkId>& named = again ? second_ : first_;
    core::StepReport report;
    std::vector<cekf::Match> matched;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      core::AssociationReport one;
      one.observation = static_cast<int>(i);
      one.outcome = core::Outcome::augmented;
      const auto known = named.find(labels[i]);
      if (known != named.end()) {
        one.outcome = core::Outcome::matched;
        one.landmark = known->second;
        matched.push_back({one.landmark, scan.observations[i], scan.T_robot_sensor});
      }
      report.associations.push_back(one);
    }
    report.joint_nis = filter.update(matched).nis;
    std::vector<core::LandmarkId> clutter;
    for (core::AssociationReport& one : report.associations) {
      if (one.outcome != core::Outcome::augmented) continue;
      const auto index = static_cast<std::size_t>(one.observation);
      one.landmark = filter.augment(scan.observations[index], scan.T_robot_sensor);
      if (labels[index] < 0) {
        clutter.push_back(one.landmark);
      } else {
        named[labels[index]] = one.landmark;
      }
    }
    tape.append(Tape::Scan{scan, report.associations, report.joint_nis, 0, clutter});
    for (const core::LandmarkId id : clutter) filter.remove(id);
    filter.switch_region_if_due();
  }

  void merge() {
    std::vector<cekf::CompressedEkf::LandmarkPair> pairs;
    std::vector<core::MergedLandmarks> merged;
    for (const auto& [label, id] : second_) {
      if (first_.count(label) == 0) {
        first_[label] = id;
      } else {
        const bool first = kept_ == Kept::first_name;
        pairs.emplace_back(first ? first_.at(label) : id, first ? id : first_.at(label));
        merged.push_back({pairs.back().first, pairs.back().second});
        first_[label] = pairs.back().first;
      }
    }
    tape.append(Tape::Merge{merged, filter.merge(pairs, 0.001).nis});
  }

  const core::Recording& run_;
  bool strangers_;
  Kept kept_;
  std::size_t scans_ = 0;
  std::vector<core::Odometry> motion_;
  std::map<core::Label, core::LandmarkId> first_;
  std::map<core::Label, core::LandmarkId> second_;

 public:
  cekf::CompressedEkf filter;
  Tape tape;
};

}  // namespace helixnav::supervisor
