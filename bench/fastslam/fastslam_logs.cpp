// SPDX-License-Identifier: BSD-3-Clause
//
// Figures 5 … 12 of fastslam_nieto2003: the car park and Victoria Park, known association from a tuned EKF, and
// unknown.
#include <fstream>
#include <memory>

#include "fastslam_study.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::bench {
namespace {

using fastslam::Association;
using fastslam::Proposal;

struct LogScore {
  PathScore path;
  int found = 0, mapped = 0;  ///< beacons with their own landmark within 1 m; mature landmarks
  double beacon_rmse_m = 0.0;
  double scan_us = 0.0, worst_percent_us = 0.0;
  double ancestors = 0.0, effective_share = 0.0;
};

void score_beacons(const std::vector<core::MapLandmark>& map, const core::Recording& recording, LogScore& score) {
  std::vector<Eigen::Vector2d> places;
  for (const core::MapLandmark& landmark : map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    places.push_back(core::transform(score.path.T_truth_map, landmark.point.mean_m));
  }
  score.mapped = static_cast<int>(places.size());
  std::vector<bool> used(places.size(), false);
  double squares = 0.0;
  for (const core::TrueLandmark& beacon : recording.true_landmarks) {
    double nearest_m = 1.0;
    std::size_t of = places.size();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double d = (places[i] - beacon.point_m).norm();
      if (!used[i] && d < nearest_m) nearest_m = d, of = i;
    }
    if (of == places.size()) continue;
    used[of] = true;
    ++score.found;
    squares += nearest_m * nearest_m;
  }
  score.beacon_rmse_m = std::sqrt(squares / std::max(1, score.found));
}

/// The compressed EKF's association, of landmarks that are mature in the end; the rest has no name.
using Names = std::vector<std::vector<fastslam::KnownName>>;

LogScore run_navigator(const core::Recording& recording, core::Nanoseconds until_ns, Names* names) {
  LogScore score;
  supervisor::NavigatorOptions options;
  supervisor::Navigator navigator(recording.start, options);
  std::vector<TimedPose> path;
  std::vector<core::StepReport> reports;
  const double begin_us = processor_us();
  for (const core::Event& event : recording.events) {
    if (core::time_of(event) > until_ns) break;
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) navigator.move(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      reports.push_back(navigator.observe(*scan));
      path.push_back({scan->t_ns, reports.back().pose.mean});
    }
  }
  score.scan_us = (processor_us() - begin_us) / static_cast<double>(path.size());
  score.path = score_path(path, recording);
  const std::vector<core::MapLandmark> map = navigator.map();
  score_beacons(map, recording, score);
  if (names == nullptr) return score;
  std::map<core::LandmarkId, bool> mature;
  for (const core::MapLandmark& landmark : map) mature[landmark.id] = landmark.state == core::LandmarkState::mature;
  for (const core::StepReport& report : reports) {
    auto& of_scan = names->emplace_back(report.associations.size(), fastslam::no_name);
    for (const core::AssociationReport& a : report.associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      fastslam::KnownName& name = of_scan[static_cast<std::size_t>(a.observation)];
      if (!used || !mature[a.landmark]) continue;
      if (std::find(of_scan.begin(), of_scan.end(), a.landmark) == of_scan.end()) name = a.landmark;
    }
  }
  return score;
}

LogScore run_particles(const core::Recording& recording, core::Nanoseconds until_ns, const fastslam::Options& options,
                       const Names* names, std::uint64_t seed) {
  LogScore score;
  fastslam::FastSlam slam(recording.start, options, seed);
  std::vector<TimedPose> path;
  std::vector<double> times_us, ancestors, effective;
  for (const core::Event& event : recording.events) {
    if (core::time_of(event) > until_ns) break;
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) slam.predict(*odometry);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const double begin_us = processor_us();
    const bool known = names != nullptr;
    const core::StepReport report = known ? slam.update_known(*scan, (*names)[path.size()]) : slam.update(*scan);
    if (!scan->observations.empty()) times_us.push_back(processor_us() - begin_us);
    path.push_back({scan->t_ns, report.pose.mean});
    ancestors.push_back(static_cast<double>(slam.cloud().distinct_ancestors));
    effective.push_back(slam.cloud().effective_size / static_cast<double>(slam.cloud().hypotheses));
  }
  score.path = score_path(path, recording);
  score_beacons(slam.map(), recording, score);
  score.scan_us = mean(times_us);
  score.worst_percent_us = quantile(times_us, 0.99);
  score.ancestors = mean(ancestors);
  score.effective_share = mean(effective);
  return score;
}

std::vector<Method> log_methods(bool known) {
  const Proposal one = Proposal::motion, two = Proposal::motion_and_scan;
  if (known) return {{"FS1 known", false, one, Association::known}, {"FS2 known", false, two, Association::known}};
  std::vector<Method> methods{
      {"FS1 nn", false, one, Association::nearest_neighbour},
      {"FS2 nn", false, two, Association::nearest_neighbour},
      {"FS1 lr", false, one, Association::likelihood_ratio},
      {"FS2 lr", false, two, Association::likelihood_ratio},
      {"FS2 sampled", false, two, Association::sampled},
      {"FS1 mht", false, one, Association::multiple_hypotheses},
      {"FS2 mht", false, two, Association::multiple_hypotheses},
  };
  for (Method& m : methods) m.weigh_unseen = false;
  methods.push_back(
      {"FS1 mht, no middle zone", false, one, Association::multiple_hypotheses, true, false, false, false});
  methods.push_back({"FS2 lr, view term", false, two, Association::likelihood_ratio});
  return methods;
}

fastslam::Options log_options(const StudySettings& settings, std::size_t particles, double detection) {
  fastslam::Options options;
  options.particles = settings.particles != 0 ? settings.particles : particles;
  options.threads = settings.threads;
  options.detection_probability = detection;
  return options;
}

void print_navigator(const LogScore& s) {
  std::printf(
      "  %-26s RMSE %.3f m, median %.3f m (%zu fixes, %zu beyond 10 m), beacons %d at %.3f m, mature %d, %.0f us a "
      "scan\n",
      "compressed EKF", s.path.rmse_m, s.path.median_m, s.path.used, s.path.beyond, s.found, s.beacon_rmse_m, s.mapped,
      s.scan_us);
  std::fflush(stdout);
}

/// All fixes of the log, of which the ASCII release kept one in five; times on that release's clock.
void take_all_fixes(const std::string& file, core::Recording& recording) {
  constexpr double ascii_clock_s = 20.967;
  std::ifstream in(file);
  if (!in) throw core::InputError(file + ": cannot be opened");
  recording.true_positions.clear();
  for (std::string line; std::getline(in, line);) {
    double t_s = 0.0, east_m = 0.0, north_m = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &t_s, &east_m, &north_m) != 3) continue;
    recording.true_positions.push_back({core::nanoseconds_from_seconds(t_s - ascii_clock_s), {east_m, north_m}});
  }
}

}  // namespace

int run_car_park(const StudySettings& settings, bool known) {
  const core::Recording recording = logs::read_recording(settings.data + "/carpark/raw/data_set.mat");
  const int seeds = settings.runs != 0 ? settings.runs : 20;
  const core::Nanoseconds end_ns = std::numeric_limits<core::Nanoseconds>::max();
  Names names;
  std::printf("car park, %d seeds, %zu particles: mean [least .. greatest] over seeds\n", seeds,
              log_options(settings, 200, 0.9).particles);
  print_navigator(run_navigator(recording, end_ns, &names));
  for (const Method& method : log_methods(known)) {
    fastslam::Options options = method.options(log_options(settings, 200, method.weigh_unseen ? 0.5 : 0.9));
    if (known) options.existence.remove = false;
    std::vector<double> rmse, beacons, found, mapped, us;
    for (int seed = 1; seed <= seeds; ++seed) {
      const LogScore s =
          run_particles(recording, end_ns, options, known ? &names : nullptr, static_cast<std::uint64_t>(seed));
      rmse.push_back(s.path.rmse_m), beacons.push_back(s.beacon_rmse_m);
      found.push_back(s.found), mapped.push_back(s.mapped), us.push_back(s.scan_us);
    }
    std::printf(
        "  %-26s RMSE %.3f [%.3f .. %.3f] m, beacons %.3f [%.3f .. %.3f] m, found %.2f (least %.0f), mature %.1f, %.0f "
        "us\n",
        method.name.c_str(), mean(rmse), quantile(rmse, 0.0), quantile(rmse, 1.0), mean(beacons),
        quantile(beacons, 0.0), quantile(beacons, 1.0), mean(found), quantile(found, 0.0), mean(mapped), mean(us));
    std::fflush(stdout);
  }
  return 0;
}

int run_victoria_park(const StudySettings& settings, double until_s, const std::string& which) {
  core::Recording recording = logs::read_recording(settings.data + "/victoria_park/raw/victoria_park_ascii.zip");
  take_all_fixes(settings.data + "/victoria_park/gps.csv", recording);
  const int seeds = settings.runs != 0 ? settings.runs : 5;
  const core::Nanoseconds until_ns = core::time_of(recording.events.front()) + core::nanoseconds_from_seconds(until_s);
  const bool known = which == "known";
  Names names;
  std::printf("Victoria Park, first %.0f s, seeds 1 to %d, %zu particles\n", until_s, seeds,
              log_options(settings, until_s < 1000 ? 200 : 100, 0.9).particles);
  print_navigator(run_navigator(recording, until_ns, &names));
  for (const Method& method : log_methods(known)) {
    if (!known && !which.empty() && method.name != which) continue;
    fastslam::Options options =
        method.options(log_options(settings, until_s < 1000 ? 200 : 100, method.weigh_unseen && !known ? 0.6 : 0.9));
    if (known) options.existence.remove = false;
    options.hypotheses.resample_every_scans = 1;
    options.hypotheses.most_children = 4;
    for (int seed = 1; seed <= seeds; ++seed) {
      const LogScore s =
          run_particles(recording, until_ns, options, known ? &names : nullptr, static_cast<std::uint64_t>(seed));
      std::printf(
          "  %-26s seed %d RMSE %.3f m, median %.3f m (%zu fixes, %zu beyond), mature %d, ESS share %.2f, ancestors of "
          "100 m ago %.1f, %.0f us a scan, p99 %.0f\n",
          method.name.c_str(), seed, s.path.rmse_m, s.path.median_m, s.path.used, s.path.beyond, s.mapped,
          s.effective_share, s.ancestors, s.scan_us, s.worst_percent_us);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace helixnav::bench
