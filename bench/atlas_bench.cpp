// SPDX-License-Identifier: BSD-3-Clause
//
// Prints the tables of docs/atlas.md. Times are processor time of one thread.
//   helixnav_bench_atlas park GRAPH [LENGTH_M [BEND_M [REDERIVE_M]]]   the iSAM graph of Victoria Park, live, against its optimum
//   helixnav_bench_atlas grid LANDMARKS                                 a street grid: the whole, joints, phases on old ground
//   helixnav_bench_atlas road LANDMARKS                                 one road: the same on new ground
//   helixnav_bench_atlas laps COUNT LAPS_KEPT                           a circular road of 4 km, driven again and again
//   helixnav_bench_atlas loop LANDMARKS                                 one long circular road with a fix every 5 km, driven twice
//   helixnav_bench_atlas close BEND_M KILOMETRES…                       a loop of 4 km closed at the end of such drives
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "atlas_world.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/pose_landmark_text.hpp"
#include "helixnav/smoothing/grow_start.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "measures.hpp"
#include "phases_of_graph.hpp"

namespace {

using namespace helixnav;

double rms(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b, bool align) {
  Eigen::Vector2d ca = Eigen::Vector2d::Zero(), cb = ca;
  for (std::size_t i = 0; i < a.size(); ++i) ca += a[i], cb += b[i];
  ca /= double(a.size()), cb /= double(b.size());
  double c = 0, s = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d p = a[i] - ca, q = b[i] - cb;
    c += p.dot(q), s += p.x() * q.y() - p.y() * q.x();
  }
  const Eigen::Matrix2d R = core::rotation(std::atan2(s, c));
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (align ? Eigen::Vector2d(R * (a[i] - ca) - (b[i] - cb)) : Eigen::Vector2d(a[i] - b[i])).squaredNorm();
  return std::sqrt(sum / double(a.size()));
}

void park(const char* path, double length_m, double bend_m, double rederive) {
  const core::Recording recording = logs::read_pose_landmark_text(path);
  smoothing::Problem problem = smoothing::build_problem(recording.events, recording.labels);
  const auto phases = atlas::testing::phases_of_graph(problem.graph, length_m);
  atlas::Options options;
  options.bend_m = bend_m;
  options.rederive_m = rederive;
  options.rederive_rad = 0.1 * rederive;
  atlas::Atlas map({}, options);
  double derive_s = 0, joint_s = 0, settle_s = 0, add_s = 0, worst = 0, begin = bench::seconds_of_this_thread();
  for (const auto& log : phases) {
    const double t0 = bench::seconds_of_this_thread();
    std::vector<core::LandmarkId> known;
    for (auto id : atlas::landmarks_of(*log))
      if (map.knows(id)) known.push_back(id);
    atlas::PointPrior prior;
    if (!known.empty()) prior = atlas::relative_to_pose(map.joint(known));
    const double t1 = bench::seconds_of_this_thread();
    auto factor = atlas::derive_factor(*log, atlas::dead_reckon(*log, &prior), known.empty() ? nullptr : &prior);
    const double t2 = bench::seconds_of_this_thread();
    map.add(std::move(factor), log);
    const double t3 = bench::seconds_of_this_thread();
    map.settle();
    const double t4 = bench::seconds_of_this_thread();
    joint_s += t1 - t0, derive_s += t2 - t1, add_s += t3 - t2, settle_s += t4 - t3, worst = std::max(worst, t4 - t3);
  }
  const double total = bench::seconds_of_this_thread() - begin;
  std::printf(
      "%5.0f m: %zu phases, %.3f s: joint %.3f, derive %.3f, add %.3f, settle %.3f (worst %.1f ms), %d fronts; chi2 "
      "%.4f\n",
      length_m, phases.size(), total, joint_s, derive_s, add_s, settle_s, 1e3 * worst, map.nodes_redone(), map.chi2());
  static std::vector<Eigen::Vector2d> best;
  static double chi2 = 0;
  if (best.empty()) {
    smoothing::grow_start(problem);
    chi2 = smoothing::optimize(problem).chi2.total();
    for (auto& l : problem.graph.landmarks) best.push_back(l.point_m);
  }
  std::vector<Eigen::Vector2d> live;
  for (std::size_t i = 0; i < best.size(); ++i) live.push_back(map.landmark(int(i)));
  auto evaluated = problem;
  std::vector<core::Pose2> poses{core::Pose2()};
  for (int k = 0; k < map.phase_count(); ++k)
    for (auto& p : map.poses_of(k)) poses.push_back(p);
  for (std::size_t i = 0; i < poses.size(); ++i) evaluated.graph.poses[i].T_world_robot = poses[i];
  for (std::size_t i = 0; i < best.size(); ++i) evaluated.graph.landmarks[i].point_m = live[i];
  std::printf("        raw %.4f aligned %.4f; optimum chi2 %.4f; of map with stored poses %.4f", rms(live, best, false),
              rms(live, best, true), chi2, smoothing::evaluate_chi2(evaluated).total());
  for (std::size_t i = 0; i < best.size(); ++i)
    evaluated.landmark_priors.push_back({int(i), live[i], 1e-12 * Eigen::Matrix2d::Identity()});
  smoothing::Options o;
  o.first_damping = 1e-8;
  smoothing::optimize(evaluated, o);
  evaluated.landmark_priors.clear();
  std::printf("; of points, poses free: %+.4f\n", smoothing::evaluate_chi2(evaluated).total() - chi2);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void add_all(atlas::Atlas& map, bench::RoadWorld& world) {
  std::vector<atlas::PhaseShape> shapes;
  const auto logs = world.phases(shapes);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    map.add(atlas::derive_factor(*logs[k], shapes[k], nullptr, 0), logs[k]);
  }
}

void print_size(const atlas::Atlas& map, int landmarks) {
  const atlas::Atlas::Size size = map.size();
  std::printf("  %d phases, depth %d, root %d, largest front %d, nnz(L) %.0f a landmark (%.2f GB), messages %.2f GB\n",
              size.phases, size.depth, size.root_front, size.largest_front, size.factor_nonzeros / landmarks,
              8e-9 * size.factor_nonzeros, 8e-9 * size.message_nonzeros);
}

/// The `count` landmarks closest to a place.
std::vector<core::LandmarkId> closest(const atlas::Atlas& map, const Eigen::Vector2d& center_m, std::size_t count) {
  double radius_m = 30.0;
  std::vector<atlas::Place> places;
  while ((places = map.near(center_m, radius_m)).size() < count) radius_m *= 1.3;
  std::sort(places.begin(), places.end(), [&](const atlas::Place& a, const atlas::Place& b) {
    return (a.point_m - center_m).squaredNorm() < (b.point_m - center_m).squaredNorm();
  });
  std::vector<core::LandmarkId> ids;
  for (std::size_t i = 0; i < count; ++i) ids.push_back(places[i].id);
  return ids;
}

/// Continues a drive, phase by phase.
void go_on(atlas::Atlas& map, bench::RoadWorld& world) {
  std::vector<atlas::PhaseShape> shapes;
  const auto logs = world.phases(shapes);
  std::vector<double> add_ms, settle_ms, near_ms, joint_ms, fronts;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    atlas::PhaseFactor factor = atlas::derive_factor(*logs[k], shapes[k], nullptr, 0);
    const int before = map.nodes_redone();
    const double t0 = bench::seconds_of_this_thread();
    map.add(std::move(factor), logs[k]);
    const double t1 = bench::seconds_of_this_thread();
    map.settle();
    const double t2 = bench::seconds_of_this_thread();
    const auto ids = closest(map, map.pose().position_m(), 60);
    const double t3 = bench::seconds_of_this_thread();
    map.joint(ids);
    const double t4 = bench::seconds_of_this_thread();
    fronts.push_back(map.nodes_redone() - before);
    add_ms.push_back(1e3 * (t1 - t0));
    settle_ms.push_back(1e3 * (t2 - t1));
    near_ms.push_back(1e3 * (t3 - t2));
    joint_ms.push_back(1e3 * (t4 - t3));
  }
  const auto print = [](const char* name, const std::vector<double>& values) {
    std::printf("  %-44s median %.3f, 90 %% %.3f, max %.3f\n", name, quantile(values, 0.5), quantile(values, 0.9),
                quantile(values, 1.0));
  };
  print("new phase: structure [ms]", add_ms);
  print("new phase: settled to the root [ms]", settle_ms);
  print("new phase: fronts", fronts);
  print("60 landmarks near the pose [ms]", near_ms);
  print("joint of 60 landmarks and the pose [ms]", joint_ms);
}

void settle_all(atlas::Atlas& map, int landmarks) {
  const double t0 = bench::seconds_of_this_thread();
  map.reshape();
  const double t1 = bench::seconds_of_this_thread();
  map.settle();
  const double t2 = bench::seconds_of_this_thread();
  print_size(map, landmarks);
  std::printf("  laid out in %.3f s, settled in %.3f s: %d fronts, %.0f us each\n", t1 - t0, t2 - t1,
              map.nodes_redone(), 1e6 * (t2 - t1) / map.nodes_redone());
}

void grid(int landmarks) {
  int streets = 0;
  bench::RoadWorld world = bench::street_grid(landmarks, streets);
  atlas::Atlas map;
  add_all(map, world);
  std::printf("grid of %d landmarks, %.0f km\n", world.landmark_count(), 1e-3 * world.driven_m());
  settle_all(map, world.landmark_count());
  core::RandomStream random(3);
  for (int turn = 0; turn < 40; ++turn) {  // on old ground
    Eigen::Vector2d to_m = world.at_m() + 100.0 * Eigen::Vector2d(random.uniform() < 0.5 ? 1 : -1, 0);
    if (random.uniform() < 0.5) to_m = world.at_m() + 100.0 * Eigen::Vector2d(0, random.uniform() < 0.5 ? 1 : -1);
    const double end_m = 100.0 * (streets - 1);
    if (to_m.minCoeff() > -1.0 && to_m.maxCoeff() < end_m + 1.0) world.drive_to(to_m);
  }
  go_on(map, world);
}

void road(int landmarks) {
  bench::RoadWorld world = bench::road_and_loop(4.0 * landmarks - 4000.0, -800.0);
  atlas::Atlas map;
  add_all(map, world);
  std::printf("road of %d landmarks, %.0f km\n", world.landmark_count(), 1e-3 * world.driven_m());
  settle_all(map, world.landmark_count());
  const double radius_m = 4000.0 / (2.0 * core::pi);
  for (double s = 3210.0; s < 3800.0; s += 10.0) {
    world.drive_to(
        {4.0 * landmarks - 4000.0 + radius_m * std::sin(s / radius_m), radius_m * (1.0 - std::cos(s / radius_m))});
  }
  go_on(map, world);
}

void close_loop(double kilometres, double bend_m) {
  const double road_m = std::max(0.0, 1000.0 * kilometres - 4000.0);
  bench::RoadWorld open = bench::road_and_loop(road_m, -280.0);
  bench::RoadWorld whole = bench::road_and_loop(road_m, 100.0);
  std::vector<atlas::PhaseShape> shapes;
  const auto logs = whole.phases(shapes);
  const std::size_t before = static_cast<std::size_t>(open.driven_m() / 40.0);
  std::vector<atlas::PhaseFactor> factors;
  for (std::size_t k = 0; k < logs.size(); ++k)
    factors.push_back(atlas::derive_factor(*logs[k], shapes[k], nullptr, 0));
  atlas::Options options;
  options.bend_m = bend_m;
  atlas::Atlas map({}, options);
  for (std::size_t k = 0; k < before; ++k) map.add(factors[k], logs[k]);
  map.reshape();
  map.settle();
  atlas::Atlas closed = map;
  double gap_m = 0.0;
  const double t0 = bench::seconds_of_this_thread();
  for (std::size_t k = before; k < factors.size(); ++k) closed.add(factors[k], logs[k]);
  const double t1 = bench::seconds_of_this_thread();
  closed.settle();
  const double t2 = bench::seconds_of_this_thread();
  for (const atlas::Place& p : closed.landmarks()) {
    if (map.knows(p.id)) gap_m = std::max(gap_m, (p.point_m - map.landmark(p.id)).norm());
  }
  std::printf(
      "closing after %.0f km: %zu phases added in %.2f ms, settled in %.2f ms, %d fronts of %d; largest move %.1f m\n",
      kilometres, factors.size() - before, 1e3 * (t1 - t0), 1e3 * (t2 - t1), closed.nodes_redone(),
      2 * closed.phase_count() - 1, gap_m);
}

/// Adds ten phases at a time, condenses unless laps_kept is negative, and settles.
void laps(int count, int laps_kept) {
  bench::RoadWorld world = bench::circle(4007.0);
  atlas::Options options;
  options.laps_kept = laps_kept;
  atlas::Atlas map({}, options);
  std::printf(" lap  phases  condensed  lap [s]  largest front  fronts [MB]  peak [MB]  sigma [m]\n");
  for (int lap = 1; lap <= count; ++lap) {
    bench::drive_lap(world, 4007.0, lap);
    std::vector<atlas::PhaseShape> shapes;
    const auto logs = world.phases(shapes);
    const double begin = bench::seconds_of_this_thread();
    for (std::size_t k = 0; k < logs.size(); ++k) {
      map.add(atlas::derive_factor(*logs[k], shapes[k], nullptr, 0), logs[k]);
      if (k % 10 != 9 && k + 1 != logs.size()) continue;
      if (laps_kept >= 0) map.condense();
      map.settle();
    }
    const double lap_s = bench::seconds_of_this_thread() - begin;
    if (lap > 5 && lap % 5 != 0) continue;
    const atlas::Atlas::Size size = map.size();
    const int far = world.landmark_count() / 2;
    std::printf("%4d  %6d  %9d  %7.2f  %13d  %11.1f  %9.0f  %9.4f\n", lap, size.phases, size.condensed, lap_s,
                size.largest_front, 8e-6 * (size.factor_nonzeros + size.message_nonzeros), bench::peak_mb(),
                std::sqrt(map.joint({far}).covariance.bottomRightCorner<2, 2>().trace()));
    std::fflush(stdout);
  }
}

core::AbsoluteFix fix_at(const Eigen::Vector2d& place_m, core::RandomStream& random) {
  core::AbsoluteFix fix;
  fix.covariance_m2.setIdentity();
  fix.position_world_m = place_m + Eigen::Vector2d(random.normal(0.0, 1.0), random.normal(0.0, 1.0));
  return fix;
}

/// Each lap: phases are added and settled 25 at a time; then the queries at its end.
void loop(int landmarks) {
  const double length_m = 4.0 * landmarks + 7.0;
  bench::RoadWorld world = bench::circle(length_m);
  core::RandomStream random(7);
  const Eigen::Vector2d first_m = bench::on_circle(length_m, 10.0, 0.0);
  core::PoseGaussian start;
  start.mean = core::Pose2(0.0, 0.0, std::atan2(first_m.y(), first_m.x()));
  atlas::Atlas map(start);
  std::printf("loop of %d landmarks, %.0f km\n", world.landmark_count(), 1e-3 * length_m);
  for (int lap = 1; lap <= 2; ++lap) {
    bench::drive_lap(world, length_m, lap);
    double worst_s = 0.0;
    const double begin = bench::seconds_of_this_thread();
    for (bool any = true; any;) {
      std::vector<atlas::PhaseShape> shapes;
      std::vector<Eigen::Vector2d> ends_m;
      const auto logs = world.phases(shapes, 25, &ends_m);
      any = !logs.empty();
      for (std::size_t k = 0; k < logs.size(); ++k) {
        const int clone = map.add(atlas::derive_factor(*logs[k], shapes[k], nullptr, 0), logs[k]) + 1;
        if (clone % 125 == 0) map.fix(clone, fix_at(ends_m[k], random));
      }
      const double settling = bench::seconds_of_this_thread();
      map.settle();
      worst_s = std::max(worst_s, bench::seconds_of_this_thread() - settling);
    }
    const double t1 = bench::seconds_of_this_thread();
    const auto near = map.near(map.pose().position_m(), 100.0);
    std::vector<core::LandmarkId> ids;
    for (const atlas::Place& place : near) ids.push_back(place.id);
    const double t2 = bench::seconds_of_this_thread();
    map.joint(ids);
    const double t3 = bench::seconds_of_this_thread();
    std::printf("lap %d: %.1f s, longest settling %.2f s; near %.2f ms, joint of %zu %.2f ms; peak %.0f MB\n", lap,
                t1 - begin, worst_s, 1e3 * (t2 - t1), ids.size(), 1e3 * (t3 - t2), bench::peak_mb());
    print_size(map, landmarks);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto number = [&words](std::size_t i, double otherwise) {
    return i < words.size() ? std::stod(words[i]) : otherwise;
  };
  const std::string what = words.empty() ? "grid" : words[0];
  const atlas::Options defaults;
  if (what == "park" && words.size() > 1)
    park(words[1].c_str(), number(2, 20.0), number(3, defaults.bend_m), number(4, defaults.rederive_m));
  if (what == "grid") grid(static_cast<int>(number(1, 10000)));
  if (what == "laps") laps(static_cast<int>(number(1, 50)), static_cast<int>(number(2, defaults.laps_kept)));
  if (what == "loop") loop(static_cast<int>(number(1, 10000)));
  if (what == "road") road(static_cast<int>(number(1, 10000)));
  for (std::size_t i = 2; what == "close" && i < words.size(); ++i)
    close_loop(number(i, 4.0), number(1, defaults.bend_m));
}
