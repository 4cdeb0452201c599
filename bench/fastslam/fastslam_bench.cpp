// SPDX-License-Identifier: BSD-3-Clause
//
// What FastSLAM costs by particles M and landmarks N: a robot drives lanes over a field that every particle was given, sees
// eight landmarks per scan within 15 m in front and decides by likelihood ratio: neighbour search, weights, drawing,
// landmark updates, births and resampling are all included.
//   helixnav_bench_fastslam                       a table over M and N
//   helixnav_bench_fastslam M N [SCANS] [THREADS]  one line of it
#include <cstdlib>

#include "fastslam_study.hpp"
#include "helixnav/core/random.hpp"

namespace {

using namespace helixnav;

constexpr double density_per_m2 = 8.0 / (0.5 * core::pi * 15.0 * 15.0), lane_m = 20.0;

/// The field, and how the lanes cross it.
struct Field {
  double side_m;
  std::vector<Eigen::Vector2d> landmarks_m;  ///< along the lanes
  std::vector<std::vector<std::size_t>> cells;
  int columns;

  explicit Field(std::size_t n) : side_m(std::sqrt(static_cast<double>(n) / density_per_m2)) {
    core::RandomStream random(7, "field");
    for (std::size_t k = 0; k < n; ++k) landmarks_m.emplace_back(random.uniform(0, side_m), random.uniform(0, side_m));
    const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      const int lane_a = static_cast<int>(a.y() / lane_m), lane_b = static_cast<int>(b.y() / lane_m);
      if (lane_a != lane_b) return lane_a < lane_b;
      return lane_a % 2 == 0 ? a.x() < b.x() : a.x() > b.x();
    };
    std::sort(landmarks_m.begin(), landmarks_m.end(), before);
    columns = static_cast<int>(side_m / 15.0) + 1;
    cells.resize(static_cast<std::size_t>(columns * columns));
    for (std::size_t k = 0; k < n; ++k) {
      const int c = static_cast<int>(landmarks_m[k].x() / 15.0), r = static_cast<int>(landmarks_m[k].y() / 15.0);
      cells[static_cast<std::size_t>(r * columns + c)].push_back(k);
    }
  }

  core::Scan look(const core::Pose2& pose, core::RandomStream& random) const {
    core::Scan scan;
    scan.field_of_view = {0.0, 15.0, -core::pi / 2.0, core::pi / 2.0};
    const int c = static_cast<int>(pose.x_m / 15.0), r = static_cast<int>(pose.y_m / 15.0);
    for (int row = std::max(0, r - 1); row <= std::min(columns - 1, r + 1); ++row) {
      for (int column = std::max(0, c - 1); column <= std::min(columns - 1, c + 1); ++column) {
        for (const std::size_t k : cells[static_cast<std::size_t>(row * columns + column)]) {
          const Eigen::Vector2d p = core::transform(core::inverse(pose), landmarks_m[k]);
          const double range_m = p.norm(), bearing_rad = std::atan2(p.y(), p.x());
          if (range_m > 15.0 || range_m < 1.0 || std::abs(bearing_rad) > core::pi / 2.0) continue;
          if (scan.observations.size() == 8) return scan;
          scan.observations.push_back(
              core::make_range_bearing(random.normal(range_m, 0.1), random.normal(bearing_rad, 0.01), 0.1, 0.01));
        }
      }
    }
    return scan;
  }
};

void run(std::size_t particles, std::size_t landmarks, int scans, unsigned threads) {
  const Field field(landmarks);
  fastslam::Options options;
  options.particles = particles;
  options.threads = threads;
  options.existence.detection_probability = 0.5;
  const core::Pose2 start(20.0, 10.0, 0.0);
  fastslam::FastSlam slam({start, Eigen::Matrix3d::Zero()}, options, 1);
  std::vector<core::PointGaussian> map;
  for (const Eigen::Vector2d& p : field.landmarks_m) map.push_back({p, 0.01 * Eigen::Matrix2d::Identity()});
  slam.begin_with(map);
  std::printf("M=%-6zu N=%-7zu", particles, landmarks);
  core::RandomStream random(3, "bench drive");
  core::Pose2 truth = start;
  std::vector<double> us;
  double observations = 0.0;
  const double length_m = field.side_m - 40.0;
  const std::size_t before = slam.memory().nodes;
  for (int k = 1; k <= scans; ++k) {
    const int row = static_cast<int>(k / length_m);
    const double along = k - row * length_m;
    const core::Pose2 next(20.0 + (row % 2 == 0 ? along : length_m - along), 10.0 + lane_m * row,
                           row % 2 == 0 ? 0.0 : core::pi);
    core::Odometry odometry;
    const Eigen::Vector3d sigma(0.05, 0.02, 0.01);
    odometry.covariance = sigma.cwiseAbs2().asDiagonal();
    odometry.T_before_after = core::Pose2(core::between(truth, next).vector() + random.normal3(odometry.covariance));
    truth = next;
    const core::Scan scan = field.look(truth, random);
    slam.predict(odometry);
    const double begin = bench::processor_us();
    slam.update(scan);
    us.push_back(bench::processor_us() - begin);
    observations += static_cast<double>(scan.observations.size());
  }
  const fastslam::MemoryReport memory = slam.memory();
  const double total_s = 1e-6 * bench::mean(us) * static_cast<double>(us.size());
  std::printf(
      " %9.0f us a scan, p99 %9.0f, %4.0f ns a particle and observation, %.2f million a second | maps %.2f MB at the "
      "start, %.2f now, greatest %.2f, lineages %.2f MB, reserved %.2f MB\n",
      bench::mean(us), bench::quantile(us, 0.99), 1e9 * total_s / (observations * static_cast<double>(particles)),
      1e-6 * observations * static_cast<double>(particles) / total_s, 1e-6 * static_cast<double>(before),
      1e-6 * static_cast<double>(memory.nodes), 1e-6 * static_cast<double>(memory.most_nodes),
      1e-6 * static_cast<double>(memory.lineages), 1e-6 * static_cast<double>(memory.reserved));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 3) {
    const auto number = [&](int k, long other) { return argc > k ? std::strtol(argv[k], nullptr, 10) : other; };
    if (number(1, 0) < 1 || number(2, 0) < 1000) {
      std::fprintf(stderr, "usage: %s [M N [SCANS] [THREADS]], N at least 1000\n", argv[0]);
      return 2;
    }
    run(static_cast<std::size_t>(number(1, 0)), static_cast<std::size_t>(number(2, 0)),
        static_cast<int>(number(3, 200)), static_cast<unsigned>(number(4, 1)));
    return 0;
  }
  for (const std::size_t n : {1000U, 10'000U, 100'000U}) {
    for (const std::size_t m : {100U, 1000U, 10'000U}) run(m, n, m == 10'000 ? 40 : 150, 1);
  }
}
