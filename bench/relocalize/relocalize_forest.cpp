// SPDX-License-Identifier: BSD-3-Clause
//
// A real forest: does the last 20 m of a drive find itself in the map of the drive before, without a prior?
//   helixnav_relocalize_forest FOLDER SEED [noise = 1] [stride = 5] [landmarks asked with = 40] [pair noise m = 0.15]
// FOLDER has poses.csv and stems.csv.gz. Every `stride`-th frame is a scan. The map is drawn by the compressed EKF from odometry
// with seeded noise (2 % along, 1 % across, 0.5 deg per sqrt(m), times `noise`), stems known by their place in the reference
// trajectory; it is the state of the filter 100 m before the end of the question. The question is what a filter of its own makes
// of the last 20 m with nearest-neighbour association; neither sees the reference. One line per scan on stdout, sum on stderr.
#include <archive.h>
#include <archive_entry.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../measures.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/relocalize/ask.hpp"

namespace {

using namespace helixnav;

constexpr double reach_m = 20.0;
constexpr double stem_sigma_m = 0.1;
constexpr double question_drive_m = 20.0;
constexpr double apart_drive_m = 100.0;
constexpr int least_sightings = 3;
const Eigen::Matrix2d stem_R = stem_sigma_m * stem_sigma_m * Eigen::Matrix2d::Identity();

struct Scan {
  core::Pose2 truth;
  double driven_m = 0.0;
  std::vector<Eigen::Vector2d> stems_m;
  std::vector<int> trees;   ///< [stem] its tree by the reference, −1: seen too rarely
  core::Odometry odometry;  ///< from the scan before, with noise
};

std::string gunzip(const std::string& path) {
  std::unique_ptr<archive, void (*)(archive*)> reader(archive_read_new(), [](archive* a) { archive_read_free(a); });
  archive_read_support_filter_all(reader.get());
  archive_read_support_format_raw(reader.get());
  archive_entry* entry = nullptr;
  if (archive_read_open_filename(reader.get(), path.c_str(), 1 << 16) != ARCHIVE_OK ||
      archive_read_next_header(reader.get(), &entry) != ARCHIVE_OK)
    throw std::runtime_error(path + ": cannot be read");
  std::string text;
  std::vector<char> block(1 << 16);
  for (la_ssize_t got = 0; (got = archive_read_data(reader.get(), block.data(), block.size())) > 0;)
    text.append(block.data(), static_cast<std::size_t>(got));
  return text;
}

std::vector<Scan> read_scans(const std::string& folder, int stride) {
  std::vector<Scan> scans;
  std::ifstream poses(folder + "/poses.csv");
  std::string line;
  double driven_m = 0.0;
  core::Pose2 last;
  for (int frame = 0; std::getline(poses, line);) {
    double x = 0.0, y = 0.0, heading = 0.0;
    if (std::sscanf(line.c_str(), "%*d,%*f,%lf,%lf,%lf", &x, &y, &heading) != 3) continue;
    const core::Pose2 pose(x, y, heading);
    if (frame > 0) driven_m += (pose.position_m() - last.position_m()).norm();
    last = pose;
    if (frame++ % stride != 0) continue;
    scans.emplace_back();
    scans.back().truth = pose;
    scans.back().driven_m = driven_m;
  }
  std::istringstream stems(gunzip(folder + "/stems.csv.gz"));
  while (std::getline(stems, line)) {
    int frame = 0;
    double x = 0.0, y = 0.0;
    if (std::sscanf(line.c_str(), "%d,%lf,%lf", &frame, &x, &y) != 3 || frame % stride != 0) continue;
    const Eigen::Vector2d stem_m(x, y);
    if (stem_m.norm() < reach_m) scans.at(static_cast<std::size_t>(frame / stride)).stems_m.push_back(stem_m);
  }
  return scans;
}

/// Trees by the reference: running means of stems within half a metre. Returns where they are.
std::vector<Eigen::Vector2d> label_trees(std::vector<Scan>& scans) {
  struct Tree {
    Eigen::Vector2d mean_m;
    int sightings = 0;
    std::size_t last = 0;
  };
  std::vector<Tree> trees;
  std::map<std::pair<int, int>, std::vector<int>> cells;
  const auto cell = [](const Eigen::Vector2d& p) {
    return std::make_pair(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
  };
  for (std::size_t s = 0; s < scans.size(); ++s)
    for (const Eigen::Vector2d& stem_m : scans[s].stems_m) {
      const Eigen::Vector2d at = core::transform(scans[s].truth, stem_m);
      int best = -1;
      double best_m = 0.5;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (const int t : cells[{cell(at).first + dx, cell(at).second + dy}]) {
            const Tree& tree = trees[static_cast<std::size_t>(t)];
            const double d_m = (tree.mean_m - at).norm();
            if (d_m >= best_m || (tree.last == s && tree.sightings > 0)) continue;
            best = t;
            best_m = d_m;
          }
      if (best < 0) {
        best = static_cast<int>(trees.size());
        trees.push_back({at, 0, s});
        cells[cell(at)].push_back(best);
      }
      Tree& tree = trees[static_cast<std::size_t>(best)];
      tree.mean_m += (at - tree.mean_m) / ++tree.sightings;
      tree.last = s;
      scans[s].trees.push_back(best);
    }
  for (Scan& scan : scans)
    for (int& tree : scan.trees)
      if (trees[static_cast<std::size_t>(tree)].sightings < least_sightings) tree = -1;
  std::vector<Eigen::Vector2d> points;
  for (const Tree& tree : trees) points.push_back(tree.mean_m);
  return points;
}

void add_odometry(std::vector<Scan>& scans, double noise, std::uint64_t seed) {
  core::RandomStream random(seed, "forest odometry");
  for (std::size_t s = 1; s < scans.size(); ++s) {
    const core::Pose2 motion = core::between(scans[s - 1].truth, scans[s].truth);
    const double length_m = std::max(0.05, motion.position_m().norm());
    const double degree = core::pi / 180.0;
    const Eigen::Vector3d sigma =
        noise * Eigen::Vector3d(0.02 * length_m, 0.01 * length_m, 0.5 * degree * std::sqrt(length_m));
    scans[s].odometry.covariance = sigma.cwiseAbs2().asDiagonal();
    scans[s].odometry.T_before_after = core::Pose2(motion.vector() + random.normal3(scans[s].odometry.covariance));
  }
}

/// A map at some moment: where trees are in the filter, by their number.
struct MapState {
  double driven_m = 0.0;
  std::map<int, Eigen::Vector2d> trees_m;
};

/// The whole drive by the compressed EKF; the map every few metres.
std::vector<MapState> draw_map(const std::vector<Scan>& scans) {
  core::PoseGaussian start;
  start.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  cekf::CompressedEkf filter(start);
  std::map<int, int> sightings;
  std::vector<MapState> states;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (s > 0) filter.predict(scans[s].odometry);
    std::vector<cekf::Match> matches;
    std::vector<std::pair<core::Observation, int>> fresh;
    for (std::size_t k = 0; k < scans[s].trees.size(); ++k) {
      const int tree = scans[s].trees[k];
      if (tree < 0) continue;
      const core::Observation observation = core::make_cartesian(scans[s].stems_m[k], stem_R);
      if (sightings[tree]++ > 0)
        matches.push_back({tree, observation, core::Pose2()});
      else
        fresh.emplace_back(observation, tree);
    }
    if (!matches.empty()) filter.update(matches);
    for (const auto& [observation, tree] : fresh) filter.augment(observation, core::Pose2(), tree);
    filter.switch_region_if_due();
    if (!states.empty() && scans[s].driven_m < states.back().driven_m + 20.0) continue;
    MapState state;
    state.driven_m = scans[s].driven_m;
    for (const auto& [tree, count] : sightings)
      if (count >= least_sightings) state.trees_m[tree] = filter.landmark_mean(tree);
    states.push_back(state);
  }
  return states;
}

/// What the vehicle knows of its last metres: a filter of its own, begun there.
struct Branch {
  relocalize::Question question;
  core::Pose2 T_branch_vehicle;
};

class BranchFilter {
 public:
  explicit BranchFilter(const core::PoseGaussian& start) : filter_(start) {}

  void take(const Scan& scan, bool first) {
    if (!first) filter_.predict(scan.odometry);
    const core::Pose2 pose = filter_.pose().mean;
    std::vector<cekf::Match> matches;
    std::vector<core::Observation> fresh;
    std::vector<core::LandmarkId> taken;
    for (const Eigen::Vector2d& stem_m : scan.stems_m) {
      const core::Observation observation = core::make_cartesian(stem_m, stem_R);
      const core::LandmarkId near = nearest(core::transform(pose, stem_m));
      if (near == core::no_landmark)
        fresh.push_back(observation);
      else if (std::find(taken.begin(), taken.end(), near) == taken.end())
        matches.push_back({near, observation, core::Pose2()}), taken.push_back(near);
    }
    for (const core::LandmarkId id : taken) ++sightings_[id];
    if (!matches.empty()) filter_.update(matches);
    for (const core::Observation& observation : fresh) sightings_[filter_.augment(observation, core::Pose2())] = 1;
    track_m_.push_back(filter_.pose().mean.position_m());
  }

  Branch finish(int needed, std::size_t most) const {
    Branch branch;
    branch.T_branch_vehicle = filter_.pose().mean;
    std::vector<std::pair<double, core::LandmarkId>> order;
    for (const auto& [id, count] : sightings_)
      if (count >= needed) order.emplace_back((filter_.landmark_mean(id) - track_m_.back()).norm(), id);
    std::sort(order.begin(), order.end());
    const bool cut = order.size() > most;
    if (cut) order.resize(most);
    for (const auto& [distance_m, id] : order) {
      relocalize::Landmark landmark;
      landmark.id = id;
      landmark.point = filter_.landmark(id);
      branch.question.landmarks.push_back(landmark);
    }
    if (cut)
      branch.question.looked.push_back({track_m_.back(), order.back().first});
    else
      for (const Eigen::Vector2d& at : track_m_) branch.question.looked.push_back({at, 0.8 * reach_m});
    return branch;
  }

 private:
  core::LandmarkId nearest(const Eigen::Vector2d& point_m) const {
    core::LandmarkId best = core::no_landmark;
    double best_m = 0.6;
    for (const auto& entry : sightings_) {
      const double d_m = (filter_.landmark_mean(entry.first) - point_m).norm();
      if (d_m < best_m) best = entry.first, best_m = d_m;
    }
    return best;
  }

  cekf::CompressedEkf filter_;
  std::map<core::LandmarkId, int> sightings_;
  std::vector<Eigen::Vector2d> track_m_;
};

Branch branch_at(const std::vector<Scan>& scans, std::size_t end, std::size_t most) {
  std::size_t begin = end;
  while (begin > 0 && scans[end].driven_m - scans[begin - 1].driven_m <= question_drive_m) --begin;
  core::PoseGaussian start;
  start.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  BranchFilter filter(start);
  for (std::size_t s = begin; s <= end; ++s) filter.take(scans[s], s == begin);
  const int scans_in_it = static_cast<int>(end - begin + 1);
  return filter.finish(std::min(least_sightings, std::max(1, scans_in_it / 2)), most);
}

relocalize::MapIndex index_of(const MapState& state, double pair_noise_m) {
  std::vector<relocalize::Landmark> landmarks;
  for (const auto& [tree, point_m] : state.trees_m) {
    relocalize::Landmark landmark;
    landmark.id = tree;
    landmark.point.mean_m = point_m;
    landmark.point.covariance_m2 = 0.5 * pair_noise_m * pair_noise_m * Eigen::Matrix2d::Identity();
    landmarks.push_back(landmark);
  }
  relocalize::MapIndex index({reach_m, pair_noise_m}, landmarks);
  index.look_around_landmarks();
  return index;
}

/// Rigid motion from the reference to the map around a place: fit to the trees within reach, at least the nearest ten.
core::Pose2 T_map_reference(const MapState& state, const std::vector<Eigen::Vector2d>& trees_m,
                            const core::Pose2& about) {
  using Complex = std::complex<double>;
  std::vector<std::pair<double, int>> order;
  for (const auto& entry : state.trees_m)
    order.emplace_back((trees_m[static_cast<std::size_t>(entry.first)] - about.position_m()).norm(), entry.first);
  std::sort(order.begin(), order.end());
  std::size_t n = 0;
  while (n < order.size() && (n < 10 || order[n].first < reach_m)) ++n;
  Complex mean_reference = 0.0;
  Complex mean_map = 0.0;
  const auto reference = [&](std::size_t i) {
    const Eigen::Vector2d& p = trees_m[static_cast<std::size_t>(order[i].second)];
    return Complex(p.x(), p.y());
  };
  const auto mapped = [&](std::size_t i) {
    const Eigen::Vector2d& p = state.trees_m.at(order[i].second);
    return Complex(p.x(), p.y());
  };
  for (std::size_t i = 0; i < n; ++i) {
    mean_reference += reference(i) / static_cast<double>(n);
    mean_map += mapped(i) / static_cast<double>(n);
  }
  Complex turn = 0.0;
  for (std::size_t i = 0; i < n; ++i) turn += (mapped(i) - mean_map) * std::conj(reference(i) - mean_reference);
  turn /= std::abs(turn);
  const Complex shift = mean_map - turn * mean_reference;
  return {shift.real(), shift.imag(), std::arg(turn)};
}

struct Sum {
  int scans = 0, with_place = 0, recalled = 0, without_place = 0, closed_without = 0, wrong = 0, ambiguous = 0;
  double seconds = 0.0, longest_s = 0.0;
  std::vector<double> error_m, error_deg;
};

struct Study {
  std::vector<Scan> scans;
  std::vector<Eigen::Vector2d> trees_m;
  std::vector<MapState> states;
  std::size_t most_landmarks = 40;
  double pair_noise_m = 0.15;
};

void ask_at(const Study& study, std::size_t s, const MapState& state, const relocalize::MapIndex& index, Sum& sum) {
  const Scan& scan = study.scans[s];
  double nearest_m = 1e9;
  for (const Scan& old : study.scans)
    if (old.driven_m <= state.driven_m)
      nearest_m = std::min(nearest_m, (old.truth.position_m() - scan.truth.position_m()).norm());
  const Branch branch = branch_at(study.scans, s, study.most_landmarks);
  const double begun_s = bench::seconds_of_this_thread();
  const relocalize::Answer answer = relocalize::ask(index, branch.question);
  const double took_s = bench::seconds_of_this_thread() - begun_s;
  double off_m = 999.0;
  double off_deg = 999.0;
  if (!answer.places.empty()) {
    const core::Pose2 answered = core::compose(answer.places.front().T_map_branch, branch.T_branch_vehicle);
    const core::Pose2 right = core::compose(T_map_reference(state, study.trees_m, scan.truth), scan.truth);
    off_m = (answered.position_m() - right.position_m()).norm();
    off_deg = std::abs(core::wrap_to_pi(answered.heading_rad - right.heading_rad)) * 180.0 / core::pi;
  }
  const bool closed = answer.verdict == relocalize::Verdict::closed;
  const bool right = off_m < 1.0 && off_deg < 3.0;
  const bool has_place = nearest_m < 10.0;
  ++sum.scans;
  ++(has_place ? sum.with_place : sum.without_place);
  sum.recalled += has_place && closed && right;
  sum.closed_without += !has_place && closed;
  sum.wrong += closed && !right;
  sum.ambiguous += answer.verdict == relocalize::Verdict::ambiguous;
  sum.seconds += took_s;
  sum.longest_s = std::max(sum.longest_s, took_s);
  if (closed && right) sum.error_m.push_back(off_m), sum.error_deg.push_back(off_deg);
  const auto& places = answer.places;
  std::printf("%zu,%.1f,%zu,%.2f,%s,%.1f,%.1f,%.2f,%zu,%zu,%.3f,%.2f,%.2f\n", s, scan.driven_m, index.size(), nearest_m,
              relocalize::name_of(answer.verdict), places.empty() ? 0.0 : places[0].evidence, answer.gap,
              answer.rival_scale, branch.question.landmarks.size(), places.empty() ? 0U : places[0].pairs.size(), off_m,
              off_deg, 1e3 * took_s);
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void run(const Study& study) {
  std::printf("scan,driven_m,map,nearest_m,verdict,evidence,gap,rival_scale,landmarks,pairs,off_m,off_deg,ms\n");
  Sum sum;
  std::unique_ptr<relocalize::MapIndex> index;
  const MapState* state = nullptr;
  for (std::size_t s = 0; s < study.scans.size(); ++s) {
    const MapState* before = state;
    for (const MapState& candidate : study.states)
      if (candidate.driven_m <= study.scans[s].driven_m - apart_drive_m) state = &candidate;
    if (state == nullptr || state->trees_m.size() < 30) continue;
    if (state != before) index = std::make_unique<relocalize::MapIndex>(index_of(*state, study.pair_noise_m));
    ask_at(study, s, *state, *index, sum);
  }
  std::fprintf(
      stderr,
      "%d scans: with a place within 10 m %d, closed right %d (%.3f); without %d, closed %d; wrong %d; ambiguous %d\n",
      sum.scans, sum.with_place, sum.recalled, sum.recalled / std::max(1.0, 1.0 * sum.with_place), sum.without_place,
      sum.closed_without, sum.wrong, sum.ambiguous);
  std::fprintf(stderr, "error median %.3f m %.2f deg, 99 %% %.3f m %.2f deg; %.2f ms mean, %.1f ms longest\n",
               quantile(sum.error_m, 0.5), quantile(sum.error_deg, 0.5), quantile(sum.error_m, 0.99),
               quantile(sum.error_deg, 0.99), 1e3 * sum.seconds / std::max(1, sum.scans), 1e3 * sum.longest_s);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 3) throw std::runtime_error("usage: FOLDER SEED [NOISE] [STRIDE] [LANDMARKS] [PAIR NOISE]");
  const auto value = [&](int at, double otherwise) { return count > at ? std::atof(arguments[at]) : otherwise; };
  Study study;
  study.scans = read_scans(arguments[1], static_cast<int>(value(4, 5)));
  study.trees_m = label_trees(study.scans);
  add_odometry(study.scans, value(3, 1.0), static_cast<std::uint64_t>(std::atoll(arguments[2])));
  study.states = draw_map(study.scans);
  study.most_landmarks = static_cast<std::size_t>(value(5, 40));
  study.pair_noise_m = value(6, 0.15);
  run(study);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "helixnav_relocalize_forest: %s\n", error.what());
  return 2;
}
