// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/pf_relocalize/point_likelihood.hpp"
#include "scatter_world.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr SensorModel sensor{0.8, 2.5};

/// The same sum written out: every observation with every landmark, visibility by predict_observation.
double brute_force(const ReferenceMap& map, const core::Scan& scan, const core::Pose2& pose,
                   const Eigen::VectorXd& xi) {
  const core::FieldOfView& view = scan.field_of_view;
  const double area = 0.5 * (view.max_bearing_rad - view.min_bearing_rad) *
                      (view.max_range_m * view.max_range_m - view.min_range_m * view.min_range_m);
  std::vector<core::PointGaussian> landmarks = map.landmarks;
  for (std::size_t i = 0; xi.size() > 0 && i < landmarks.size(); ++i) {
    landmarks[i].mean_m += map.latent.middleRows<2>(2 * static_cast<Eigen::Index>(i)) * xi;
  }
  double sum = 0.0;
  for (const core::Observation& z : scan.observations) {
    const double jacobian = z.kind == core::ObservationKind::range_bearing ? z.z[0] : 1.0;
    const double extraneous = sensor.extraneous_per_scan / area * jacobian;
    double density = extraneous;
    for (const core::PointGaussian& m : landmarks) {
      density += sensor.detection_probability * std::exp(log_likelihood_linearised(z, pose, scan.T_robot_sensor, m));
    }
    sum += std::log(density / extraneous);
  }
  for (const core::PointGaussian& m : landmarks) {
    const auto seen =
        core::predict_observation(core::ObservationKind::range_bearing, pose, scan.T_robot_sensor, m.mean_m);
    const double middle = 0.5 * (view.min_bearing_rad + view.max_bearing_rad);
    const bool in_view =
        seen.z_hat[0] >= view.min_range_m && seen.z_hat[0] <= view.max_range_m &&
        std::abs(core::wrap_to_pi(seen.z_hat[1] - middle)) <= 0.5 * (view.max_bearing_rad - view.min_bearing_rad);
    if (in_view) sum -= sensor.detection_probability;
  }
  return sum;
}

Particles cloud_about(const core::Pose2& centre, std::size_t n, std::size_t modes, core::RandomStream& random) {
  Particles cloud;
  cloud.latent.resize(modes);
  cloud.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double spread = i % 2 == 0 ? 0.2 : 6.0;
    cloud.set_pose(i, {centre.x_m + random.normal(0.0, spread), centre.y_m + random.normal(0.0, spread),
                       centre.heading_rad + random.normal(0.0, 0.05 * spread)});
    for (auto& column : cloud.latent) column[i] = random.normal();
  }
  return cloud;
}

void expect_brute_force(const ReferenceMap& map, const core::Scan& scan, const core::Pose2& centre) {
  core::RandomStream random(3, "particles");
  const Particles cloud = cloud_about(centre, 600, static_cast<std::size_t>(map.latent_modes()), random);
  ScanLikelihood likelihood(map, sensor);
  likelihood.set_scan(scan);
  std::vector<double> out(cloud.size());
  likelihood.evaluate(cloud, 0, cloud.size(), out.data());
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    Eigen::VectorXd xi(map.latent_modes());
    for (Eigen::Index k = 0; k < xi.size(); ++k) xi[k] = cloud.latent[static_cast<std::size_t>(k)][i];
    EXPECT_NEAR(out[i], brute_force(map, scan, cloud.pose(i), xi),
                1e-9 + 2e-4 * static_cast<double>(scan.observations.size()))
        << i;
  }
}

TEST(ScanLikelihood, IsTheSumOverAllPairsWithClutterAndVisibility) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    test::ScatterWorld world({}, seed);
    expect_brute_force(world.map, world.scan(), world.truth);
  }
}

TEST(ScanLikelihood, KnowsTheLeverArmAndAnOddFieldOfView) {
  test::ScatterWorld world({}, 5);
  core::Scan scan = world.scan();
  scan.T_robot_sensor = core::Pose2(3.78, 0.5, 0.4);
  scan.field_of_view = {2.0, 25.0, -2.9, 1.0};  // more than half a turn, not symmetric
  expect_brute_force(world.map, scan, world.truth);
  scan.field_of_view = {0.0, 30.0, -core::pi, core::pi};
  expect_brute_force(world.map, scan, world.truth);
}

TEST(ScanLikelihood, TakesCartesianObservationsWithFullCovariance) {
  test::ScatterWorld world({}, 6);
  core::Scan scan = world.scan();
  for (core::Observation& z : scan.observations) {
    z = core::make_cartesian(z.z[0] * Eigen::Vector2d(std::cos(z.z[1]), std::sin(z.z[1])),
                             (Eigen::Matrix2d() << 0.1, 0.04, 0.04, 0.05).finished());
  }
  expect_brute_force(world.map, scan, world.truth);
}

TEST(ScanLikelihood, MovesLandmarksByTheLatentModesOfEachParticle) {
  test::ScatterWorld world({}, 7);
  core::RandomStream random(1, "modes");
  world.map.latent.resize(world.map.latent.rows(), 3);
  for (Eigen::Index k = 0; k < world.map.latent.size(); ++k) world.map.latent.data()[k] = random.normal(0.0, 0.2);
  world.map.prior_by_latent = Eigen::MatrixXd::Zero(3, 3);
  expect_brute_force(world.map, world.scan(), world.truth);
}

TEST(ScanLikelihood, DoesNotDependOnHowParticlesAreDivided) {
  test::ScatterWorld world({}, 8);
  core::RandomStream random(2, "particles");
  const Particles cloud = cloud_about(world.truth, 700, 0, random);
  ScanLikelihood likelihood(world.map, sensor);
  likelihood.set_scan(world.scan());
  std::vector<double> whole(700), parts(700);
  likelihood.evaluate(cloud, 0, 700, whole.data());
  likelihood.evaluate(cloud, 0, 256, parts.data());
  likelihood.evaluate(cloud, 256, 512, parts.data() + 256);
  likelihood.evaluate(cloud, 512, 700, parts.data() + 512);
  EXPECT_EQ(whole, parts);
}

TEST(ScanLikelihood, OfAnEmptyScanIsWhatShouldHaveBeenSeen) {
  test::ScatterWorld world({}, 9);
  core::Scan scan = world.scan();
  scan.observations.clear();
  expect_brute_force(world.map, scan, world.truth);
}

TEST(ScanLikelihood, RefusesUnboundedViewsAndBrokenSensorModels) {
  test::ScatterWorld world({}, 10);
  core::Scan scan = world.scan();
  scan.field_of_view = {};
  ScanLikelihood likelihood(world.map, sensor);
  EXPECT_THROW(likelihood.set_scan(scan), core::PreconditionError);
  EXPECT_THROW(ScanLikelihood(world.map, SensorModel{1.0, 2.5}), core::PreconditionError);
  EXPECT_THROW(ScanLikelihood(world.map, SensorModel{0.8, 0.0}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
