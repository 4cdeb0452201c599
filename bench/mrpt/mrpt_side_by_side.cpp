// SPDX-License-Identifier: BSD-3-Clause
//
// The compressed EKF (both retractions) beside MRPT's CRangeBearingKFSLAM2D (kfEKFNaive, kfEKFAlaDavison), which is
// measured as Debian ships it. One world for all: a circle with a landmark every 2 m, seen up to 8 m away, association
// known (landmarkID), assumed noise = true noise. One lap in steps of 7 m maps all N landmarks; then steps of 1 m over old
// ground are the timed updates, by the processor time of the thread. The filters take turns, so that noise hits
// all alike: in blocks of 5 timed steps, and also ("cold") step by step, where each finds caches that the others have
// filled: at N = 800 MRPT walks through 20 to 60 MB in every step.
//   ms       median of predict + update of the timed steps
//   cold     the same step by step
//   mean     mean with all else that the timed steps took, cold ones too: region switches
//   whole s  all steps of a run, mapping included, mean over the seeds
//   RMS      of all N landmarks to the truth at the end, over the seeds, in the frame of the start, not aligned
//   less D   mean over the seeds of a world's RMS less kfEKFAlaDavison's in the same world, and twice its standard error
// About 3 min of processor time, most of it kfEKFNaive at N = 200 and 800.
// usage: helixnav_mrpt_side_by_side [CSV file [noise factor]]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "../measures.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"
#include "kf_slam.hpp"

namespace {

using namespace helixnav;

constexpr double landmark_every_m = 2.0;
constexpr double landmark_offset_m = 3.0;  // to either side of the road
constexpr double sensor_range_m = 8.0;
constexpr double mapping_step_m = 7.0;
constexpr double timed_step_m = 1.0;

/// Per step. At N = 800 every filter here needs a loop that closes within a few metres, else one linearisation of the
/// closing update is not enough: with factor 2 all end about 17 m off, kfEKFAlaDavison 70 m (seed 1).
struct Noise {
  explicit Noise(double factor)
      : odometry_covariance(Eigen::Vector3d(std::pow(0.005 * factor, 2), std::pow(0.00125 * factor, 2),
                                            std::pow(factor * 0.025 * core::pi / 180.0, 2))
                                .asDiagonal()),
        sigma_range_m(0.025 * factor),
        sigma_bearing_rad(factor * 0.25 * core::pi / 180.0) {}

  Eigen::Matrix3d odometry_covariance;
  double sigma_range_m;
  double sigma_bearing_rad;
};

struct Sighting {
  int landmark;
  double range_m;
  double bearing_rad;
};

/// The input of all filters in one step.
struct Step {
  Noise noise;
  core::Odometry odometry;
  std::vector<Sighting> sightings;
};

/// The vehicle starts at the origin along x and drives the circle counter-clockwise.
class CircleWorld {
 public:
  CircleWorld(int landmarks, const Noise& noise, std::uint64_t seed)
      : noise_(noise), random_(seed, "circle world"), radius_m_(landmarks * landmark_every_m / (2.0 * core::pi)) {
    for (int i = 0; i < landmarks; ++i) {
      const double angle = 2.0 * core::pi * (i + random_.uniform(-0.25, 0.25)) / landmarks;
      const double r_m = radius_m_ + (i % 2 == 0 ? landmark_offset_m : -landmark_offset_m) + random_.uniform(-1.0, 1.0);
      landmarks_m.emplace_back(r_m * std::sin(angle), radius_m_ - r_m * std::cos(angle));
    }
  }

  std::vector<Eigen::Vector2d> landmarks_m;

  double lap_m() const { return 2.0 * core::pi * radius_m_; }

  Step drive(double step_m) {
    const core::Pose2 moved(radius_m_ * std::sin(step_m / radius_m_), radius_m_ * (1.0 - std::cos(step_m / radius_m_)),
                            step_m / radius_m_);
    truth_ = core::compose(truth_, moved);
    Step step{noise_, {}, {}};
    if (step_m > 0.0) {
      step.odometry.covariance = noise_.odometry_covariance;
      step.odometry.T_before_after = core::Pose2(moved.vector() + random_.normal3(noise_.odometry_covariance));
    }
    look(step);
    return step;
  }

 private:
  void look(Step& step) {
    const core::Pose2 T_robot_world = core::inverse(truth_);
    for (std::size_t i = 0; i < landmarks_m.size(); ++i) {
      const Eigen::Vector2d p = core::transform(T_robot_world, landmarks_m[i]);
      if (p.norm() > sensor_range_m) continue;
      step.sightings.push_back({static_cast<int>(i), p.norm() + random_.normal(0.0, noise_.sigma_range_m),
                                std::atan2(p.y(), p.x()) + random_.normal(0.0, noise_.sigma_bearing_rad)});
    }
  }

  Noise noise_;
  core::RandomStream random_;
  double radius_m_;
  core::Pose2 truth_;
};

double rms_m(const std::vector<Eigen::Vector2d>& truth_m, const std::vector<Eigen::Vector2d>& estimate_m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth_m.size(); ++i) sum += (truth_m[i] - estimate_m[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth_m.size()));
}

/// The times of a filter, over all seeds.
struct Times {
  std::vector<double> warm_s;  ///< predict + update of the timed steps
  std::vector<double> cold_s;
  double timed_s = 0.0;
  double whole_s = 0.0;
};

enum class Kind { mapping, warm, cold };

/// One of the filters on one seed.
struct Contestant {
  explicit Contestant(Times& its_times) : times(its_times) {}
  virtual ~Contestant() = default;
  virtual void take(const Step& step, Kind kind) = 0;
  virtual std::vector<Eigen::Vector2d> map_m(std::size_t landmarks) const = 0;

  void note(double update_s, double rest_s, Kind kind) const {
    times.whole_s += update_s + rest_s;
    if (kind == Kind::mapping) return;
    times.timed_s += update_s + rest_s;
    (kind == Kind::warm ? times.warm_s : times.cold_s).push_back(update_s);
  }

  Times& times;
};

class Compressed : public Contestant {
 public:
  Compressed(Times& its_times, cekf::Retraction retraction)
      : Contestant(its_times), filter_(core::PoseGaussian{}, options(retraction)) {}

  void take(const Step& step, Kind kind) override {
    std::vector<cekf::Match> matches;
    std::vector<std::pair<std::size_t, core::Observation>> fresh;
    for (const Sighting& s : step.sightings) {
      const auto i = static_cast<std::size_t>(s.landmark);
      if (i >= ids_.size()) ids_.resize(i + 1, core::no_landmark);
      const core::Observation z = core::make_range_bearing(s.range_m, core::wrap_to_pi(s.bearing_rad),
                                                           step.noise.sigma_range_m, step.noise.sigma_bearing_rad);
      if (ids_[i] == core::no_landmark) {
        fresh.emplace_back(i, z);
      } else {
        matches.push_back({ids_[i], z, {}});
      }
    }
    const double start = bench::seconds_of_this_thread();
    filter_.predict(step.odometry);
    if (!matches.empty()) filter_.update(matches);
    const double updated = bench::seconds_of_this_thread();
    for (const auto& [i, z] : fresh) ids_[i] = filter_.augment(z, {});
    filter_.switch_region_if_due();
    note(updated - start, bench::seconds_of_this_thread() - updated, kind);
  }

  std::vector<Eigen::Vector2d> map_m(std::size_t landmarks) const override {
    std::vector<Eigen::Vector2d> result;
    for (std::size_t i = 0; i < landmarks; ++i) result.push_back(filter_.landmark(ids_.at(i)).mean_m);
    return result;
  }

 private:
  static cekf::FilterOptions options(cekf::Retraction retraction) {
    cekf::FilterOptions result;
    result.retraction = retraction;
    return result;
  }

  cekf::CompressedEkf filter_;
  std::vector<core::LandmarkId> ids_;
};

class Mrpt : public Contestant {
 public:
  Mrpt(Times& its_times, mrpt::bayes::TKFMethod method, const Noise& noise)
      : Contestant(its_times), noise_(noise), filter_(noise.sigma_range_m, noise.sigma_bearing_rad, method) {}

  void take(const Step& step, Kind kind) override {
    auto action = action_of(step.odometry);
    auto frame = frame_of(step.sightings);
    const double start = bench::seconds_of_this_thread();
    filter_.take(action, frame);
    note(bench::seconds_of_this_thread() - start, 0.0, kind);
  }

  std::vector<Eigen::Vector2d> map_m(std::size_t landmarks) const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Eigen::Vector2d> result(landmarks, Eigen::Vector2d(nan, nan));
    for (const auto& [id, point_m] : filter_.landmarks_m()) result.at(static_cast<std::size_t>(id)) = point_m;
    return result;
  }

 private:
  static mrpt::obs::CActionCollection::Ptr action_of(const core::Odometry& odometry) {
    mrpt::obs::CActionRobotMovement2D move;
    mrpt::math::CMatrixDouble33 covariance;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) covariance(r, c) = odometry.covariance(r, c);
    }
    const core::Pose2& T = odometry.T_before_after;
    move.poseChange =
        mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(T.x_m, T.y_m, T.heading_rad), covariance);
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(move);
    return actions;
  }

  mrpt::obs::CSensoryFrame::Ptr frame_of(const std::vector<Sighting>& sightings) const {
    auto seen = mrpt::obs::CObservationBearingRange::Create();
    seen->minSensorDistance = 0.0F;
    seen->maxSensorDistance = static_cast<float>(sensor_range_m);
    seen->fieldOfView_yaw = static_cast<float>(2.0 * core::pi);
    seen->sensor_std_range = static_cast<float>(noise_.sigma_range_m);
    seen->sensor_std_yaw = static_cast<float>(noise_.sigma_bearing_rad);
    for (const Sighting& s : sightings) {
      mrpt::obs::CObservationBearingRange::TMeasurement z;
      z.range = static_cast<float>(s.range_m);
      z.yaw = static_cast<float>(core::wrap_to_pi(s.bearing_rad));
      z.pitch = 0.0F;
      z.landmarkID = s.landmark;
      seen->sensedData.push_back(z);
    }
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(seen);
    return frame;
  }

  Noise noise_;
  testing::KfSlam filter_;
};

constexpr std::array<const char*, 4> names{"mrpt_naive", "mrpt_davison", "cekf_standard", "cekf_right_invariant"};

using Contestants = std::vector<std::unique_ptr<Contestant>>;

Contestants contestants(std::array<Times, 4>& times, const Noise& noise) {
  Contestants result;
  result.push_back(std::make_unique<Mrpt>(times[0], mrpt::bayes::kfEKFNaive, noise));
  result.push_back(std::make_unique<Mrpt>(times[1], mrpt::bayes::kfEKFAlaDavison, noise));
  result.push_back(std::make_unique<Compressed>(times[2], cekf::Retraction::standard));
  result.push_back(std::make_unique<Compressed>(times[3], cekf::Retraction::right_invariant));
  return result;
}

struct Size {
  int landmarks;
  int seeds;
  int blocks;  ///< of warm steps
  int cold_steps;
};

/// All filters through one world.
void race(Contestants& filters, CircleWorld& world, const Size& size) {
  const auto in_turn = [&](double step_m, Kind kind, int steps) {
    std::vector<Step> block;
    for (int k = 0; k < steps; ++k) block.push_back(world.drive(step_m));
    for (auto& filter : filters) {
      for (const Step& step : block) filter->take(step, kind);
    }
  };
  in_turn(0.0, Kind::mapping, 1);
  const int mapping_steps = static_cast<int>(std::ceil(world.lap_m() / mapping_step_m));
  for (int k = 0; k < mapping_steps; ++k) in_turn(world.lap_m() / mapping_steps, Kind::mapping, 1);
  for (int k = 0; k < size.blocks; ++k) in_turn(timed_step_m, Kind::warm, 5);
  for (int k = 0; k < size.cold_steps; ++k) in_turn(timed_step_m, Kind::cold, 1);
}

double median_ms(std::vector<double> s) {
  std::sort(s.begin(), s.end());
  return 1e3 * s[s.size() / 2];
}

/// Median, cold median, mean [ms], whole [s].
std::array<double, 4> figures(const Times& times, int seeds) {
  return {median_ms(times.warm_s), median_ms(times.cold_s),
          1e3 * times.timed_s / static_cast<double>(times.warm_s.size() + times.cold_s.size()), times.whole_s / seeds};
}

/// Mean of a − b and twice its standard error, for more than one.
std::array<double, 2> paired(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  double mean = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) mean += (a[k] - b[k]) / n;
  double square = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) square += std::pow(a[k] - b[k] - mean, 2);
  return {mean, 2.0 * std::sqrt(square / (n - 1.0) / n)};
}

void compare_at(const Size& size, const Noise& noise, std::ofstream& csv) {
  std::array<Times, 4> times;
  std::array<double, 4> square_m2{};
  std::array<std::vector<double>, 4> rms;
  for (int seed = 1; seed <= size.seeds; ++seed) {
    CircleWorld world(size.landmarks, noise, static_cast<std::uint64_t>(seed));
    Contestants filters = contestants(times, noise);
    race(filters, world, size);
    for (std::size_t i = 0; i < filters.size(); ++i) {
      rms[i].push_back(rms_m(world.landmarks_m, filters[i]->map_m(world.landmarks_m.size())));
      square_m2[i] += std::pow(rms[i].back(), 2) / size.seeds;
    }
  }
  const std::array<double, 4> naive = figures(times[0], size.seeds);
  const std::array<double, 4> davison = figures(times[1], size.seeds);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::array<double, 4> own = figures(times[i], size.seeds);
    std::printf("%5d %5d %-21s", size.landmarks, size.seeds, names[i]);
    csv << size.landmarks << ',' << names[i];
    for (std::size_t k = 0; k < own.size(); ++k) {
      std::printf(" %9.4f %6.1f", own[k], std::min(naive[k], davison[k]) / own[k]);
      csv << ',' << own[k];
    }
    const auto [less, error] = paired(rms[i], rms[1]);
    std::printf(" %9.4f %9.5f", std::sqrt(square_m2[i]), less);
    if (size.seeds > 1) std::printf(" +- %.5f", error);
    std::printf("\n");
    csv << ',' << std::sqrt(square_m2[i]) << '\n';
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::ofstream csv;
  if (argc > 1 && argv[1][0] == '-') {
    std::printf("usage: %s [file.csv [noise factor]]\n", argv[0]);
    return 2;
  }
  if (argc > 1) csv.open(argv[1]);
  const Noise noise(argc > 2 ? std::strtod(argv[2], nullptr) : 1.0);
  csv << "N,filter,median_ms,cold_ms,mean_ms,whole_s,rms_m\n";
  std::printf("x: how many times faster than the better MRPT variant\n");
  std::printf("%5s %5s %-21s %9s %6s %9s %6s %9s %6s %9s %6s %9s %9s\n", "N", "seeds", "filter", "ms", "x", "cold", "x",
              "mean", "x", "whole s", "x", "RMS m", "less D");
  for (const Size& size : {Size{100, 400, 1, 1}, Size{200, 100, 2, 2}, Size{400, 1, 8, 10}, Size{800, 1, 2, 4}}) {
    compare_at(size, noise, csv);
  }
  return 0;
}
