// SPDX-License-Identifier: BSD-3-Clause
// The Navigator driven by the input: stretches of simulated circuits on which it gets lost and searches, interspersed
// with events that no sensor makes. After every call: a finite pose, a symmetric positive covariance, and as many
// landmarks in the filter as on the map; after a call that threw: everything as before it.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstring>

#include <Eigen/Eigenvalues>

#include "fuzz_input.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/sim/simulate.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace {

using namespace helixnav;

/// Two laps of 70 m among 14 landmarks, with odometry so poor that the second lap begins in doubt.
core::Recording circuit(std::uint64_t seed) {
  sim::Scenario s = sim::named_scenario("circuit");
  s.world.loop_length_m = {70.0, 70.0};
  s.world.drive_on_m = 50.0;
  s.world.returns = 1;
  s.world.circuit_landmarks = 14;
  s.vehicle.geometry = {2.0, 0.0};
  s.vehicle.speed_mps = 2.0;
  s.vehicle.odometry_period_s = 0.5;
  s.vehicle.samples_per_scan = 2;
  s.vehicle.lookahead_m = 3.0;
  s.scanner.field_of_view = {0.5, 9.0, -core::pi, core::pi};
  s.scanner.detection_probability = 0.95;
  s.true_noise.odometry = {0.3, 0.06};
  s.true_noise.sigma_range_m = 0.1;
  s.true_noise.sigma_bearing_rad = 0.02;
  s.assumed_noise = s.true_noise;
  return sim::simulate(s, seed);
}

const core::Recording& drive(std::size_t which) {
  static const std::vector<core::Recording> drives = [] {
    std::vector<core::Recording> made;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) made.push_back(circuit(seed));
    return made;
  }();
  return drives[which % drives.size()];
}

class Driver {
 public:
  explicit Driver(const core::Recording& recording, const supervisor::NavigatorOptions& options)
      : navigator_(recording.start, options) {
    remember();
  }

  /// True if a search is open afterwards.
  bool take(const core::Event& event) {
    bool searching = false;
    try {
      const std::optional<core::StepReport> report = navigator_.take(event);
      if (report) searching = check(*report, event);
      remember();
    } catch (const core::PreconditionError&) {
      expect_unchanged();
    } catch (const core::NumericalError&) {
      expect_unchanged();
    }
    check_state();
    return searching;
  }

 private:
  void remember() {
    pose_ = navigator_.pose();
    map_ = navigator_.map();
  }

  void expect_unchanged() const {
    const core::PoseGaussian pose = navigator_.pose();
    fuzz::require((pose.mean.vector() - pose_.mean.vector()).norm() <= 1e-9, "a call that threw moved the pose");
    fuzz::require((pose.covariance - pose_.covariance).norm() <= 1e-6 * (1e-12 + pose_.covariance.norm()),
                  "a call that threw changed the covariance");
    const std::vector<core::MapLandmark> map = navigator_.map();
    fuzz::require(map.size() == map_.size(), "a call that threw changed the number of landmarks");
    for (std::size_t i = 0; i < map.size(); ++i) {
      fuzz::require(
          map[i].id == map_[i].id && map[i].observations == map_[i].observations && map[i].state == map_[i].state,
          "a call that threw changed a landmark");
    }
  }

  void check_state() const {
    const core::PoseGaussian pose = navigator_.pose();
    fuzz::require(pose.mean.vector().allFinite() && pose.covariance.allFinite(), "a pose that is not finite");
    fuzz::require((pose.covariance - pose.covariance.transpose()).cwiseAbs().maxCoeff() <=
                      1e-9 * pose.covariance.cwiseAbs().maxCoeff(),
                  "a covariance that is not symmetric");
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(pose.covariance, Eigen::EigenvaluesOnly);
    fuzz::require(eigen.eigenvalues()[0] >= -1e-9 * (1e-9 + eigen.eigenvalues()[2]),
                  "a covariance that is not positive");
    for (const core::MapLandmark& landmark : navigator_.map()) {
      fuzz::require(landmark.point.mean_m.allFinite() && landmark.point.covariance_m2.allFinite(),
                    "a landmark that is not finite");
      fuzz::require(landmark.point.covariance_m2.diagonal().minCoeff() >= -1e-12, "a negative variance of a landmark");
    }
    fuzz::require(navigator_.map().size() == navigator_.filter().landmarks().size(), "map and filter differ");
  }

  static bool check(const core::StepReport& report, const core::Event& event) {
    const auto& scan = std::get<core::Scan>(event);
    fuzz::require(report.associations.size() == scan.observations.size(), "a report of another number of observations");
    for (std::size_t i = 0; i < report.associations.size(); ++i) {
      fuzz::require(report.associations[i].observation == static_cast<int>(i), "observations out of order");
    }
    return report.mode == core::Mode::searching;
  }

  supervisor::Navigator navigator_;
  core::PoseGaussian pose_;
  std::vector<core::MapLandmark> map_;
};

double any_number(FuzzedDataProvider& input) {
  static constexpr double special[] = {0.0, -0.0, 1e-320, 1e-300, 1e-9, 1.0, -1.0, 3.2, 1e4, 1e9, 1e150, 1e300, -1e300};
  switch (input.ConsumeIntegralInRange(0, 5)) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return input.ConsumeBool() ? HUGE_VAL : -HUGE_VAL;
    case 2:
      return special[input.ConsumeIntegralInRange<std::size_t>(0, std::size(special) - 1)];
    default:
      return input.ConsumeFloatingPointInRange(-50.0, 50.0);
  }
}

core::Observation any_observation(FuzzedDataProvider& input) {
  core::Observation observation;
  observation.kind = static_cast<core::ObservationKind>(input.ConsumeIntegralInRange(0, 3));
  const int rows = input.ConsumeIntegralInRange(0, 9) == 0 ? 3 - core::dimension(observation.kind)
                                                           : core::dimension(observation.kind);
  observation.z.resize(rows);
  observation.R.setZero(rows, rows);
  for (int r = 0; r < rows; ++r) {
    observation.z[r] = any_number(input);
    observation.R(r, r) = input.ConsumeBool() ? 0.01 : any_number(input);
  }
  return observation;
}

/// Something that may occur between two events of a drive.
core::Event any_event(FuzzedDataProvider& input, const core::Event& near) {
  const core::Nanoseconds t_ns = core::time_of(near) + input.ConsumeIntegralInRange(-3, 3) * 100'000'000;
  switch (input.ConsumeIntegralInRange(0, 3)) {
    case 0: {
      core::Odometry odometry;
      odometry.t_ns = t_ns;
      odometry.T_before_after = {any_number(input), any_number(input), any_number(input)};
      odometry.covariance.diagonal() << any_number(input), any_number(input), any_number(input);
      return odometry;
    }
    case 1: {
      core::AbsoluteFix fix;
      fix.t_ns = t_ns;
      fix.position_world_m = {any_number(input), any_number(input)};
      fix.covariance_m2 *= any_number(input);
      return fix;
    }
    case 2: {  // a good scan, with much of it repeated
      if (!std::holds_alternative<core::Scan>(near)) return near;
      core::Scan scan = std::get<core::Scan>(near);
      const std::vector<core::Observation> once = scan.observations;
      for (int copies = input.ConsumeIntegralInRange(1, 60); copies > 0; --copies) {
        scan.observations.insert(scan.observations.end(), once.begin(), once.end());
      }
      return scan;
    }
    default: {
      core::Scan scan;
      scan.t_ns = t_ns;
      if (input.ConsumeBool()) scan.field_of_view = {any_number(input), any_number(input), -3.0, 3.0};
      for (int n = input.ConsumeIntegralInRange(0, 12); n > 0; --n) scan.observations.push_back(any_observation(input));
      return scan;
    }
  }
}

/// Reports at the end in how many sequences a search was open: a fuzzer that never gets there tests little.
struct Tally {
  std::size_t sequences = 0;
  std::size_t searched = 0;
  ~Tally() {
    if (sequences > 0) {
      std::fprintf(stderr, "sequences %zu, with a search %zu (%.1f %%)\n", sequences, searched,
                   100.0 * static_cast<double>(searched) / static_cast<double>(sequences));
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Tally tally;
  FuzzedDataProvider input(data, size);
  const core::Recording& recording = drive(input.ConsumeIntegral<std::uint8_t>());
  supervisor::NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  options.search.relocalizer.most_particles = 600;
  options.search.relocalizer.least_particles = 200;
  options.search.seed = input.ConsumeIntegral<std::uint8_t>();
  Driver driver(recording, options);
  bool searched = false;
  for (const core::Event& event : recording.events) {
    const int choice = input.remaining_bytes() == 0 ? 0 : input.ConsumeIntegralInRange(0, 15);
    if (choice == 15) continue;  // lost on the way
    if (choice == 14) searched = driver.take(event) || searched;
    if (choice == 13 || choice == 12) searched = driver.take(any_event(input, event)) || searched;
    searched = driver.take(event) || searched;
  }
  ++tally.sequences;
  if (searched) ++tally.searched;
  return 0;
}
