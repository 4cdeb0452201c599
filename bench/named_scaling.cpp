// SPDX-License-Identifier: BSD-3-Clause
//
// Steps of a NamedNavigator on a circular road, mapped and then revisited. A table; times are processor time of one thread.
//   helixnav_named_scaling LANDMARKS…
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "measures.hpp"

namespace {

using namespace helixnav;

/// A landmark every 8 m on both sides of a circular road, seen up to 25 m away in scans every 2 m, a fix of 1 m every 5 km.
class CircleRoad {
 public:
  static constexpr double step_m = 2.0;

  explicit CircleRoad(int landmarks) : landmarks_(landmarks), radius_m_(4.0 * landmarks / (2.0 * core::pi)) {}

  long steps_a_lap() const { return 2 * landmarks_; }

  core::Odometry motion(long k) {
    core::Odometry odometry;
    odometry.t_ns = k * core::Nanoseconds{100'000'000};
    odometry.covariance = Eigen::Vector3d(0.02, 0.01, 5e-4).cwiseAbs2().asDiagonal();
    odometry.T_before_after =
        core::Pose2(core::between(pose(k - 1), pose(k)).vector() + random_.normal3(odometry.covariance));
    return odometry;
  }

  core::Scan look(long k, std::vector<std::int64_t>& identities) {
    constexpr double reach_m = 25.0;
    core::Scan scan;
    scan.t_ns = k * core::Nanoseconds{100'000'000};
    scan.field_of_view.max_range_m = reach_m;
    identities.clear();
    const core::Pose2 T_robot_world = core::inverse(pose(k));
    const long here = std::lround(std::floor(step_m * static_cast<double>(k) / 4.0));
    for (long i = here - 8; i <= here + 8; ++i) {
      const long name = (i + landmarks_) % landmarks_;
      const Eigen::Vector2d seen_m = core::transform(T_robot_world, landmark(name));
      if (seen_m.norm() > reach_m) continue;
      const Eigen::Vector2d noise_m(random_.normal(0.0, 0.1), random_.normal(0.0, 0.1));
      scan.observations.push_back(core::make_cartesian(seen_m + noise_m, 0.01 * Eigen::Matrix2d::Identity()));
      identities.push_back(name);
    }
    return scan;
  }

  core::AbsoluteFix fix(long k) {
    core::AbsoluteFix fix;
    fix.t_ns = k * core::Nanoseconds{100'000'000};
    fix.covariance_m2.setIdentity();
    fix.position_world_m = pose(k).position_m() + Eigen::Vector2d(random_.normal(0.0, 1.0), random_.normal(0.0, 1.0));
    return fix;
  }

  core::Pose2 pose(long k) const {
    const double angle_rad = step_m * static_cast<double>(k) / radius_m_;
    return {radius_m_ * std::sin(angle_rad), radius_m_ * (1.0 - std::cos(angle_rad)), core::wrap_to_pi(angle_rad)};
  }

 private:
  Eigen::Vector2d landmark(long i) const {
    const double angle_rad = (4.0 * static_cast<double>(i - i % 2) + 2.0) / radius_m_;
    const double off_m = i % 2 == 0 ? -6.0 : 6.0;
    return {(radius_m_ + off_m) * std::sin(angle_rad), radius_m_ - (radius_m_ + off_m) * std::cos(angle_rad)};
  }

  long landmarks_;
  double radius_m_;
  core::RandomStream random_{4};
};

struct Steps {
  std::vector<double> us;
  int hand_overs = 0;

  void print(int mapped, const char* where) {
    std::vector<double> sorted = us;
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double share) {
      return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    };
    double sum = 0.0;
    for (const double one : us) sum += one;
    std::printf("%8d  %-10s  %6.1f  %6.1f  %8.1f  %8.1f  %5d  %6.2f\n", mapped, where,
                sum / static_cast<double>(us.size()), quantile(0.5), quantile(0.99), sorted.back(), hand_overs,
                1e-3 * bench::peak_mb());
    std::fflush(stdout);
  }
};

class Drive {
 public:
  explicit Drive(int landmarks) : road_(landmarks), navigator_(core::PoseGaussian{}) {}

  Steps go(long count) {
    Steps steps;
    for (const long end = k_ + count; k_ < end; ++k_) {
      const core::Odometry motion = road_.motion(k_);
      const core::Scan scan = road_.look(k_, identities_);
      if (k_ % 2500 == 2499) navigator_.fix(road_.fix(k_ - 1));
      const long phase = navigator_.filter().phase();
      const double begin = bench::seconds_of_this_thread();
      if (k_ > 0) navigator_.move(motion);
      mapped_ = navigator_.observe(scan, identities_).mapped_landmarks;
      steps.us.push_back(1e6 * (bench::seconds_of_this_thread() - begin));
      steps.hand_overs += navigator_.filter().phase() < phase ? 1 : 0;  // a filter that has just begun
    }
    return steps;
  }
  int mapped() const { return mapped_; }
  double error_m() const { return (navigator_.pose().mean.position_m() - road_.pose(k_ - 1).position_m()).norm(); }
  const CircleRoad& road() const { return road_; }

 private:
  CircleRoad road_;
  supervisor::NamedNavigator navigator_;
  std::vector<std::int64_t> identities_;
  long k_ = 0;
  int mapped_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::printf("  mapped  ground      mean us  median      99 %%       max  hand-overs  peak GB\n");
  for (int i = 1; i < argc; ++i) {
    const int landmarks = std::stoi(argv[i]);
    Drive drive(landmarks);
    const long measured = std::min<long>(5000, drive.road().steps_a_lap() / 2);
    drive.go(drive.road().steps_a_lap() - measured - 20);
    Steps fresh = drive.go(measured);
    fresh.print(drive.mapped(), "new");
    drive.go(40);
    Steps old = drive.go(measured);
    old.print(drive.mapped(), "old");
    std::printf("          error at the end %.2f m\n", drive.error_m());
  }
}
