// SPDX-License-Identifier: BSD-3-Clause
//
// The experiment of hybrid_masson2003 §4 on a recorded log: the particle filter is started at a return to known ground
// with the pose and the uncertainty of the compressed EKF, and run many times. Figures 2, 4, 5 and 6 as JSON on stdout, a
// table of all returns on stderr; relocalization_figures.py runs this and plots.
//   helixnav_relocalization_study LOG [blind seconds = 0] [runs = 50] [unseen metres = 100] [landmarks = 3]
//
// Return: a scan that matches `landmarks` landmarks unseen for `unseen` metres of driving, if no scan in as many metres
// before it did. The filter whose estimate starts the particles has not seen that scan, nor, to get lost as the paper's
// does where there are no trees, those of the `blind` seconds before it. The particles' map is what it has not seen for
// 60 % of `unseen`.
// Converged: one mode with 99 % of the mass and σ below 0.5 m and 2°, even after one scan; beside it the paper's rule,
// σ below twice the noise of the odometry since the previous scan. Right: less than 2 m and 8° off
// the pose that the navigator, which is never lost on these logs, has at the same scan.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "helixnav/core/event_loop.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/pf_relocalize/helix_proposal.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace {

using namespace helixnav;
using Json = nlohmann::json;

constexpr int scans_a_run = 60;
constexpr double degree = core::pi / 180.0;

/// A drive of the whole log, step by step.
class Driver {
 public:
  Driver(const core::Recording& recording, double unseen_m)
      : navigator_(recording.start, scan_by_scan()), loop_(recording.events, ear_), unseen_m_(unseen_m) {}
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Up to and including the next scan; false at the end.
  bool next() {
    ear_.motion.reset();
    const Eigen::Vector2d before_m = navigator_.pose().mean.position_m();
    const std::optional<core::StepReport> report = loop_.next();
    if (!report) return false;
    driven_m += (report->pose.mean.position_m() - before_m).norm();
    note_landmarks(*report);
    return true;
  }

  const core::Scan* scan() const { return ear_.scan; }
  /// Since the previous scan.
  const std::optional<core::Odometry>& motion() const { return ear_.motion; }

  std::vector<core::LandmarkId> old_landmarks() const {
    std::vector<core::LandmarkId> ids;
    for (const core::MapLandmark& landmark : navigator_.map()) {
      const auto seen = last_seen_m_.find(landmark.id);
      const bool old = seen != last_seen_m_.end() && driven_m - seen->second > 0.6 * unseen_m_;
      if (old && landmark.state == core::LandmarkState::mature) ids.push_back(landmark.id);
    }
    return ids;
  }

  const cekf::CompressedEkf& filter() const { return navigator_.filter(); }

  double driven_m = 0.0;
  int long_unseen = 0;  ///< landmarks matched that were unseen for unseen_m

 private:
  /// Listens to the events that the navigator takes.
  struct Ear {
    supervisor::Navigator& navigator;
    const core::Scan* scan = nullptr;
    std::optional<core::Odometry> motion;

    std::optional<core::StepReport> take(const core::Event& event) {
      const auto* odometry = std::get_if<core::Odometry>(&event);
      if (odometry != nullptr) motion = motion ? core::chain(*motion, *odometry) : *odometry;
      if (const auto* seen = std::get_if<core::Scan>(&event)) scan = seen;
      return navigator.take(event);
    }
  };

  void note_landmarks(const core::StepReport& report) {
    long_unseen = 0;
    for (const core::AssociationReport& a : report.associations) {
      if (a.outcome != core::Outcome::matched && a.outcome != core::Outcome::augmented) continue;
      const auto seen = last_seen_m_.find(a.landmark);
      if (seen != last_seen_m_.end() && driven_m - seen->second > unseen_m_) ++long_unseen;
      last_seen_m_[a.landmark] = driven_m;
    }
  }

  static supervisor::NavigatorOptions scan_by_scan() {
    supervisor::NavigatorOptions options;
    options.search.enabled = false;
    return options;
  }

  supervisor::Navigator navigator_;
  Ear ear_{navigator_, nullptr, std::nullopt};
  core::EventLoop<Ear> loop_;
  double unseen_m_;
  std::map<core::LandmarkId, double> last_seen_m_;
};

struct Step {
  const core::Scan* scan;
  core::Odometry motion;
  core::Pose2 pose;
  double driven_m;
  bool is_return;
};

std::vector<Step> drive(const core::Recording& recording, double unseen_m, int landmarks) {
  std::vector<Step> steps;
  double last_return_m = -unseen_m;
  for (Driver driver(recording, unseen_m); driver.next();) {
    const bool many = driver.long_unseen >= landmarks;
    const bool is_return = many && driver.driven_m - last_return_m > unseen_m;
    if (many) last_return_m = driver.driven_m;
    steps.push_back({driver.scan(), driver.motion().value_or(core::no_motion(driver.scan()->t_ns)),
                     driver.filter().pose().mean, driver.driven_m, is_return});
  }
  return steps;
}

/// The estimate that a particle filter is started with at step `at`.
struct Start {
  std::size_t at;
  core::JointGaussian joint;  ///< pose predicted to that scan, and old landmarks
};

Start start_at(const Driver& driver, const std::vector<Step>& steps, std::size_t from, std::size_t at) {
  cekf::CompressedEkf filter = driver.filter();
  for (std::size_t k = from + 1; k <= at; ++k) filter.predict(steps[k].motion);
  const core::PoseGaussian pose = filter.pose();
  const double reach_m =
      steps[at].scan->field_of_view.max_range_m + 2.0 * std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace()) + 60.0;
  const std::vector<core::LandmarkId> near = filter.landmarks_within(pose.mean.position_m(), reach_m);
  const std::vector<core::LandmarkId> old = driver.old_landmarks();
  std::vector<core::LandmarkId> chosen;
  std::set_intersection(near.begin(), near.end(), old.begin(), old.end(), std::back_inserter(chosen));
  return {at, filter.joint(chosen)};
}

std::vector<Start> starts(const core::Recording& recording, const std::vector<Step>& steps, double blind_s,
                          double unseen_m) {
  std::multimap<std::size_t, std::size_t> from_to;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    if (!steps[k].is_return || k + scans_a_run >= steps.size()) continue;
    std::size_t from = k - 1;
    while (from > 0 && static_cast<double>(steps[k].scan->t_ns - steps[from].scan->t_ns) < blind_s * 1e9) --from;
    from_to.emplace(from, k);
  }
  std::vector<Start> result;
  Driver driver(recording, unseen_m);
  for (std::size_t k = 0; driver.next(); ++k) {
    const auto [first, last] = from_to.equal_range(k);
    for (auto one = first; one != last; ++one) {
      Start start = start_at(driver, steps, k, one->second);
      if (start.joint.ids.size() >= 3) result.push_back(std::move(start));
    }
  }
  return result;
}

double position_sigma_m(const Eigen::Matrix3d& covariance) { return std::sqrt(covariance(0, 0) + covariance(1, 1)); }

Json json_of(const core::Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }

Json cloud_of(const pf_relocalize::Particles& particles, const core::Pose2& T_world_base, std::size_t most) {
  Json cloud = Json::array();
  const std::size_t stride = std::max<std::size_t>(1, particles.size() / most);
  for (std::size_t i = 0; i < particles.size(); i += stride) {
    cloud.push_back(json_of(core::compose(T_world_base, particles.pose(i))));
  }
  return cloud;
}

/// One start of the particle filter, followed over scans_a_run scans. Index 0 is the prior.
struct RunHistory {
  std::vector<core::Pose2> mean;
  std::vector<double> sigma_m, error_m;
  int gate_scans = -1, paper_scans = -1;  ///< −1: not within scans_a_run
  bool gate_right = false, paper_right = false;
};

const pf_relocalize::GateLimits one_tight_mode{0.99, 0.5, 2.0 * degree, 1, -1e9};

bool is_right(const core::Pose2& a, const core::Pose2& b) {
  return (a.position_m() - b.position_m()).norm() < 2.0 &&
         std::abs(core::wrap_to_pi(a.heading_rad - b.heading_rad)) < 8.0 * degree;
}

RunHistory run_once(const Start& start, const std::vector<Step>& steps, std::uint64_t seed, Json* clouds) {
  const pf_relocalize::ReferenceMap map = pf_relocalize::build_reference_map(start.joint);
  const core::Pose2 T_world_base = map.T_world_base;
  RunHistory history;
  const auto note = [&](const core::PoseGaussian& T_base_robot, const core::Pose2& reference) {
    history.mean.push_back(core::compose(T_world_base, T_base_robot.mean));
    history.sigma_m.push_back(position_sigma_m(T_base_robot.covariance));
    history.error_m.push_back((history.mean.back().position_m() - reference.position_m()).norm());
  };
  note(map.prior, steps[start.at].pose);
  pf_relocalize::Relocalizer search(map, *steps[start.at].scan, {}, seed);
  for (int k = 0; k < scans_a_run; ++k) {
    const Step& step = steps[start.at + static_cast<std::size_t>(k)];
    if (k > 0) search.step(step.motion, *step.scan);
    note(search.state().cloud, step.pose);
    const core::Pose2 best = core::compose(T_world_base, search.state().modes.front().pose.mean);
    if (history.gate_scans < 0 && meets_gate(search.state(), one_tight_mode)) {
      history.gate_scans = k + 1;
      history.gate_right = is_right(best, step.pose);
    }
    if (history.paper_scans < 0 && meets_paper_rule(search.state(), step.motion)) {
      history.paper_scans = k + 1;
      history.paper_right = is_right(history.mean.back(), step.pose);
    }
    if (clouds == nullptr) continue;
    clouds->push_back({{"scans", k + 1},
                       {"reference", json_of(step.pose)},
                       {"cloud", cloud_of(search.particles(), T_world_base, k < 6 ? 400 : 200)}});
  }
  return history;
}

/// Poses that the helices of a scan propose, before anything is weighed.
Json proposed(const pf_relocalize::ReferenceMap& map, const core::Scan& scan, double prior_share, std::size_t count) {
  pf_relocalize::ScanLikelihood likelihood(map, {});
  likelihood.set_scan(scan);
  pf_relocalize::HelixOptions options;
  options.prior_share = prior_share;
  pf_relocalize::HelixProposal proposal(map, likelihood, options);
  pf_relocalize::Particles particles;
  particles.latent.resize(static_cast<std::size_t>(map.latent_modes()));
  particles.resize(count);
  core::RandomStream random(1, "helices");
  proposal.allot(count, 0.5);
  proposal.sample(particles, 0, count, random);
  return cloud_of(particles, map.T_world_base, count);
}

/// Figure 2: one observation and its landmark, heading unknown.
Json one_helix(const Start& start, const std::vector<Step>& steps) {
  pf_relocalize::ReferenceMap map = pf_relocalize::build_reference_map(start.joint);
  core::Scan scan = *steps[start.at].scan;
  const core::Pose2 sensor = core::compose(steps[start.at].pose, scan.T_robot_sensor);
  std::size_t landmark = 0, observation = 0;
  double best_m = 1e9;
  for (std::size_t j = 0; j < scan.observations.size(); ++j) {
    const core::LocatedLandmark seen =
        core::locate_landmark(scan.observations[j], steps[start.at].pose, scan.T_robot_sensor);
    for (std::size_t i = 0; i < map.ids.size(); ++i) {
      const double apart_m = (core::transform(map.T_world_base, map.landmarks[i].mean_m) - seen.point_world_m).norm();
      if (apart_m >= best_m) continue;
      best_m = apart_m;
      landmark = i;
      observation = j;
    }
  }
  map.landmarks = {map.landmarks[landmark]};
  map.ids = {map.ids[landmark]};
  scan.observations = {scan.observations[observation]};
  map.prior.covariance = Eigen::Vector3d(1e4, 1e4, 1.0).asDiagonal();
  const Eigen::Vector2d point_m = core::transform(map.T_world_base, map.landmarks[0].mean_m);
  return {{"landmark", {point_m.x(), point_m.y()}},
          {"sensor", json_of(sensor)},
          {"range_m", scan.observations[0].z[0]},
          {"bearing_deg", scan.observations[0].z[1] / degree},
          {"poses", proposed(map, scan, 0.0, 1500)}};
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Json summary_of(const Start& start, const std::vector<Step>& steps, const std::vector<RunHistory>& runs) {
  std::vector<double> gate, paper;
  double after_m = 0.0, error_after_m = 0.0;
  int gate_wrong = 0, paper_wrong = 0;
  for (const RunHistory& run : runs) {
    after_m += run.sigma_m[1] / static_cast<double>(runs.size());
    error_after_m += run.error_m[1] / static_cast<double>(runs.size());
    if (run.gate_scans > 0) gate.push_back(run.gate_scans);
    if (run.paper_scans > 0) paper.push_back(run.paper_scans);
    gate_wrong += run.gate_scans > 0 && !run.gate_right ? 1 : 0;
    paper_wrong += run.paper_scans > 0 && !run.paper_right ? 1 : 0;
  }
  const Step& step = steps[start.at];
  return {{"t_s", static_cast<double>(step.scan->t_ns - steps.front().scan->t_ns) * 1e-9},
          {"driven_m", step.driven_m},
          {"observations", step.scan->observations.size()},
          {"landmarks", start.joint.ids.size()},
          {"sigma_before_m", runs.front().sigma_m[0]},
          {"sigma_heading_deg", std::sqrt(start.joint.covariance(2, 2)) / degree},
          {"error_before_m", runs.front().error_m[0]},
          {"sigma_after_m", after_m},
          {"error_after_m", error_after_m},
          {"gate_scans", median(gate)},
          {"gate_met", gate.size()},
          {"gate_wrong", gate_wrong},
          {"paper_scans", median(paper)},
          {"paper_met", paper.size()},
          {"paper_wrong", paper_wrong}};
}

/// Figures 4 to 6 for one return.
Json figures_of(const Start& start, const std::vector<Step>& steps, const std::vector<RunHistory>& runs) {
  Json mean = Json::array(), sigma = Json::array(), error = Json::array(), reference = Json::array();
  for (std::size_t k = 0; k < runs.front().mean.size(); ++k) {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    double sigma_m = 0.0, error_m = 0.0;
    for (const RunHistory& run : runs) {
      position_m += run.mean[k].position_m() / static_cast<double>(runs.size());
      sigma_m += run.sigma_m[k] / static_cast<double>(runs.size());
      error_m += run.error_m[k] / static_cast<double>(runs.size());
    }
    mean.push_back({position_m.x(), position_m.y()});
    sigma.push_back(sigma_m);
    error.push_back(error_m);
    reference.push_back(json_of(steps[start.at + (k > 0 ? k - 1 : 0)].pose));
  }
  Json landmarks = Json::array();
  for (const Eigen::Vector2d& point_m : start.joint.points_m) landmarks.push_back({point_m.x(), point_m.y()});
  const pf_relocalize::ReferenceMap map = pf_relocalize::build_reference_map(start.joint);
  Json clouds = Json::array();
  clouds.push_back({{"scans", 0},
                    {"reference", json_of(steps[start.at].pose)},
                    {"cloud", proposed(map, *steps[start.at].scan, pf_relocalize::HelixOptions{}.prior_share, 1500)}});
  run_once(start, steps, 1, &clouds);
  return {{"summary", summary_of(start, steps, runs)},
          {"landmarks", landmarks},
          {"clouds", clouds},
          {"mean", mean},
          {"sigma_m", sigma},
          {"error_m", error},
          {"reference", reference},
          {"helix", one_helix(start, steps)}};
}

void print(const Json& s) {
  const auto number = [&](const char* key) { return s[key].is_number() ? s[key].get<double>() : std::nan(""); };
  std::fprintf(stderr,
               "%7.0f %7.0f %4.0f %4.0f  %6.2f %5.1f %6.2f  %6.2f %6.2f  %5.0f %3.0f %3.0f  %5.0f %3.0f %3.0f\n",
               number("t_s"), number("driven_m"), number("observations"), number("landmarks"), number("sigma_before_m"),
               number("sigma_heading_deg"), number("error_before_m"), number("sigma_after_m"), number("error_after_m"),
               number("gate_scans"), number("gate_met"), number("gate_wrong"), number("paper_scans"),
               number("paper_met"), number("paper_wrong"));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr,
                 "usage: helixnav_relocalization_study LOG [blind seconds = 0] [runs = 50] [unseen metres = 100] "
                 "[landmarks = 3]\n");
    return 2;
  }
  const double blind_s = argc > 2 ? std::atof(argv[2]) : 0.0;
  const int runs = argc > 3 ? std::atoi(argv[3]) : 50;
  const double unseen_m = argc > 4 ? std::atof(argv[4]) : 100.0;
  const int landmarks = argc > 5 ? std::atoi(argv[5]) : 3;
  const core::Recording recording = logs::read_recording(argv[1]);
  const std::vector<Step> steps = drive(recording, unseen_m, landmarks);
  std::fprintf(stderr, "    t_s driven  obs  map  sigma  head  error   after  error   gate met bad  paper met bad\n");
  Json result = {{"recording", recording.name}, {"blind_s", blind_s},     {"runs", runs},
                 {"unseen_m", unseen_m},        {"landmarks", landmarks}, {"returns", Json::array()}};
  Json shown;
  double widest_m = -1.0;
  for (const Start& start : starts(recording, steps, blind_s, unseen_m)) {
    std::vector<RunHistory> histories;
    for (int run = 1; run <= runs; ++run) {
      histories.push_back(run_once(start, steps, static_cast<std::uint64_t>(run), nullptr));
    }
    const Json summary = summary_of(start, steps, histories);
    print(summary);
    result["returns"].push_back(summary);
    if (summary["sigma_before_m"] < widest_m) continue;
    widest_m = summary["sigma_before_m"];
    shown = figures_of(start, steps, histories);
  }
  result["shown"] = shown;
  std::printf("%s\n", result.dump().c_str());
  return 0;
}
