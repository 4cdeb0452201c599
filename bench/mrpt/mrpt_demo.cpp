// SPDX-License-Identifier: BSD-3-Clause
//
// MRPT's demo of kf-slam through CRangeBearingKFSLAM2D (both methods), as Debian ships it, and through MapBuilder (both
// retractions), on the same frames: as recorded, from the first and from the second frame on (kf-slam skips the
// first), and drawn anew from the demo's truth with the noise that its files state, once for each seed.
//   as it is   mean distance of the landmarks to the truth, in the frame where the map began
//   aligned    the same after the best rigid motion, which removes where the first frames put the map
//   less kf    difference to CRangeBearingKFSLAM2D's default method on the same draw, with its standard error
// usage: helixnav_mrpt_demo [runs [folder of MRPT's datasets]]
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/evaluation/alignment.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "kf_slam.hpp"

namespace {

using namespace helixnav;
using mrpt::obs::CObservationBearingRange;

constexpr double sigma_range_m = 0.03;  // as in the demo's configuration file
constexpr double sigma_bearing_rad = 0.1 * core::pi / 180.0;

struct Frame {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr seen;
};

struct Demo {
  std::vector<Frame> frames;
  std::vector<core::Pose2> true_path;
  std::map<std::int64_t, Eigen::Vector2d> truth_m;  ///< by landmarkID
};

/// The numbers in a line of a file with % comments.
std::vector<std::vector<double>> rows_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; words >> value;) row.push_back(value);
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

Demo read_demo(const std::string& folder) {
  Demo demo;
  mrpt::obs::CRawlog rawlog;
  rawlog.loadFromRawLogFile(folder + "/kf-slam_demo.rawlog");
  auto action = mrpt::obs::CActionCollection::Create();
  for (std::size_t i = 0; i < rawlog.size(); ++i) {
    const auto entry = rawlog.getAsGeneric(i);
    if (const auto moved = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(entry)) action = moved;
    if (const auto seen = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(entry)) {
      demo.frames.push_back({std::exchange(action, mrpt::obs::CActionCollection::Create()), seen});
    }
  }
  for (const auto& row : rows_of(folder + "/kf-slam_demo_ground_truth.txt")) {
    demo.truth_m[static_cast<std::int64_t>(row.at(6))] = {row[0], row[1]};
  }
  for (const auto& row : rows_of(folder + "/kf-slam_demo_ground_truth_robot_path.txt")) {
    demo.true_path.emplace_back(row.at(0), row.at(1), row.at(3));
  }
  return demo;
}

mrpt::obs::CActionCollection::Ptr drawn_action(const Demo& demo, std::size_t i, core::RandomStream& random) {
  auto actions = mrpt::obs::CActionCollection::Create();
  const auto movement = demo.frames[i].action->getBestMovementEstimation();
  if (i == 0 || !movement) return actions;
  mrpt::poses::CPosePDFGaussian stated(*movement->poseChange);
  const Eigen::Vector3d moved = core::between(demo.true_path[i - 1], demo.true_path[i]).vector() +
                                random.normal3(Eigen::Matrix3d(stated.cov.asEigen()));
  mrpt::obs::CActionRobotMovement2D drawn;
  drawn.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;  // its covariance is kept
  drawn.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(moved(0), moved(1), moved(2)), stated.cov);
  actions->insert(drawn);
  return actions;
}

/// The same drive past the same landmarks with other noise.
Demo drawn(const Demo& demo, std::uint64_t seed) {
  core::RandomStream random(seed, "demo of kf-slam");
  Demo result = demo;
  for (std::size_t i = 0; i < demo.frames.size(); ++i) {
    result.frames[i].action = drawn_action(demo, i, random);
    auto seen = std::make_shared<CObservationBearingRange>(
        *demo.frames[i].seen->getObservationByClass<CObservationBearingRange>());
    const mrpt::poses::CPose3D& mounted = seen->sensorLocationOnRobot;
    const core::Pose2 sensor = core::compose(demo.true_path[i], core::Pose2(mounted.x(), mounted.y(), mounted.yaw()));
    for (auto& measured : seen->sensedData) {
      const Eigen::Vector2d p = core::transform(core::inverse(sensor), demo.truth_m.at(measured.landmarkID));
      measured.range = static_cast<float>(p.norm() + random.normal(0.0, sigma_range_m));
      measured.yaw =
          static_cast<float>(core::wrap_to_pi(std::atan2(p.y(), p.x()) + random.normal(0.0, sigma_bearing_rad)));
    }
    result.frames[i].seen = mrpt::obs::CSensoryFrame::Create();
    result.frames[i].seen->insert(seen);
  }
  return result;
}

using Map = testing::KfSlam::Landmarks;

Map map_of_kf_slam(const Demo& demo, std::size_t first, mrpt::bayes::TKFMethod method) {
  testing::KfSlam filter(sigma_range_m, sigma_bearing_rad, method);
  for (std::size_t i = first; i < demo.frames.size(); ++i) {
    Frame frame = demo.frames[i];
    filter.take(frame.action, frame.seen);
  }
  return filter.landmarks_m();
}

Map map_of_builder(const Demo& demo, std::size_t first, const std::string& retraction) {
  helixnav::mrpt_adapter::MapBuilderOptions options;
  options.std_sensor_range = sigma_range_m;
  options.std_sensor_yaw_rad = sigma_bearing_rad;
  options.retraction = retraction;
  helixnav::mrpt_adapter::MapBuilder builder(options);
  for (std::size_t i = first; i < demo.frames.size(); ++i) {
    mrpt::obs::CActionCollection action = *demo.frames[i].action;
    mrpt::obs::CSensoryFrame seen = *demo.frames[i].seen;
    builder.processActionObservation(action, seen);
  }
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, std::int64_t> ids;
  mrpt::math::CVectorDouble state;
  builder.getCurrentState(pose, points, ids, state);
  Map map_m;
  for (const auto& [index, id] : ids) map_m[id] = {points[index].x, points[index].y};
  return map_m;
}

struct Errors {
  double as_it_is_m = 0.0;
  double aligned_m = 0.0;
  std::size_t landmarks = 0;
};

Errors errors_of(const Map& map_m, const Map& truth_m) {
  std::vector<Eigen::Vector2d> estimates_m, truths_m;
  for (const auto& [id, point_m] : map_m) {
    estimates_m.push_back(point_m);
    truths_m.push_back(truth_m.at(id));
  }
  constexpr double none_is_left_out_m = 1e3;
  const core::Pose2 T_truth_map = evaluation::align_rigidly(truths_m, estimates_m, none_is_left_out_m).T_a_b;
  Errors errors;
  errors.landmarks = map_m.size();
  const double share = 1.0 / static_cast<double>(map_m.size());
  for (std::size_t i = 0; i < truths_m.size(); ++i) {
    errors.as_it_is_m += share * (estimates_m[i] - truths_m[i]).norm();
    errors.aligned_m += share * (core::transform(T_truth_map, estimates_m[i]) - truths_m[i]).norm();
  }
  return errors;
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> all{"kf-slam, method 0 (default)", "kf-slam, method 1 (a la Davison)",
                                            "MapBuilder (default)", "MapBuilder, retraction = standard"};
  return all;
}

std::vector<Errors> of_all(const Demo& demo, std::size_t first) {
  std::vector<Errors> all;
  for (const auto method : {mrpt::bayes::kfEKFNaive, mrpt::bayes::kfEKFAlaDavison}) {
    all.push_back(errors_of(map_of_kf_slam(demo, first, method), demo.truth_m));
  }
  for (const char* retraction : {"right-invariant", "standard"}) {
    all.push_back(errors_of(map_of_builder(demo, first, retraction), demo.truth_m));
  }
  return all;
}

/// Mean, and mean and standard error of the difference to the first filter.
void print_figure(const std::vector<std::vector<Errors>>& runs, std::size_t which, double Errors::*figure) {
  const double n = static_cast<double>(runs.size());
  double mean = 0.0, difference = 0.0, square = 0.0;
  for (const std::vector<Errors>& run : runs) {
    const double d = run[which].*figure - run[0].*figure;
    mean += run[which].*figure / n;
    difference += d / n;
    square += d * d / n;
  }
  const double variance = std::max(0.0, square - difference * difference);
  const double error = std::sqrt(variance / std::max(1.0, n - 1.0));
  std::printf("  %7.4f  %+8.4f +- %.4f", 1e3 * mean, 1e3 * difference, 1e3 * error);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 100;
  const Demo demo = read_demo(argc > 2 ? argv[2] : "/usr/share/mrpt/datasets");
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    std::printf("as recorded, from frame %zu on, mm: landmarks, as it is, aligned\n", first);
    const std::vector<Errors> all = of_all(demo, first);
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::printf("  %-34s  %3zu  %7.4f  %7.4f\n", names()[k].c_str(), all[k].landmarks, 1e3 * all[k].as_it_is_m,
                  1e3 * all[k].aligned_m);
    }
  }
  std::vector<std::vector<Errors>> drawn_runs;
  for (int seed = 1; seed <= runs; ++seed)
    drawn_runs.push_back(of_all(drawn(demo, static_cast<std::uint64_t>(seed)), 0));
  if (drawn_runs.empty()) return 0;
  std::printf("drawn anew %d times, mm: as it is, less kf; aligned, less kf\n", runs);
  for (std::size_t k = 0; k < names().size(); ++k) {
    std::printf("  %-34s", names()[k].c_str());
    print_figure(drawn_runs, k, &Errors::as_it_is_m);
    print_figure(drawn_runs, k, &Errors::aligned_m);
    std::printf("\n");
  }
  return 0;
}
