// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/opengl/stock_objects.h>

#include "map_builder_impl.hpp"
#include "matrices.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::img::TColor;
using mrpt::opengl::CSetOfObjects;

constexpr TColor mature_colour(40, 90, 200);
constexpr TColor tentative_colour(150, 150, 150);
constexpr TColor vehicle_colour(220, 50, 30);
constexpr TColor particle_colour(230, 140, 0);

mrpt::opengl::CEllipsoid2D::Ptr ellipse(const core::PointGaussian& point, float quantiles, const TColor& colour) {
  auto drawn = mrpt::opengl::CEllipsoid2D::Create();
  drawn->setCovMatrix(mrpt_of(point.covariance_m2));
  drawn->setQuantiles(quantiles);
  drawn->enableDrawSolid3D(false);
  drawn->setColor_u8(colour);
  drawn->setLocation(point.mean_m.x(), point.mean_m.y(), 0.0);
  return drawn;
}

void add_text(CSetOfObjects& scene, const std::string& text, const Eigen::Vector2d& at_m, const TColor& colour) {
  auto drawn = mrpt::opengl::CText::Create(text);
  drawn->setColor_u8(colour);
  drawn->setLocation(at_m.x(), at_m.y(), 0.0);
  scene.insert(drawn);
}

void add_path(CSetOfObjects& scene, const std::vector<core::Pose2>& path) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  for (std::size_t i = 1; i < path.size(); ++i) {
    lines->appendLine(path[i - 1].x_m, path[i - 1].y_m, 0.0, path[i].x_m, path[i].y_m, 0.0);
  }
  lines->setColor_u8(vehicle_colour);
  lines->setName("path");
  scene.insert(lines);
}

void add_vehicle(CSetOfObjects& scene, const core::PoseGaussian& pose, float quantiles) {
  auto corner = mrpt::opengl::stock_objects::CornerXYZSimple(1.0F, 2.0F);
  corner->setPose(mrpt::poses::CPose3D(pose.mean.x_m, pose.mean.y_m, 0.0, pose.mean.heading_rad, 0.0, 0.0));
  corner->setName("vehicle");
  scene.insert(corner);
  scene.insert(ellipse({pose.mean.position_m(), pose.covariance.topLeftCorner<2, 2>()}, quantiles, vehicle_colour));
}

void add_particles(CSetOfObjects& scene, const std::vector<core::Pose2>& cloud) {
  if (cloud.empty()) return;
  auto points = mrpt::opengl::CPointCloud::Create();
  for (const core::Pose2& pose : cloud) {
    points->insertPoint(static_cast<float>(pose.x_m), static_cast<float>(pose.y_m), 0.0F);
  }
  points->setPointSize(3.0F);
  points->setColor_u8(particle_colour);
  points->setName("particles");
  scene.insert(points);
}

}  // namespace

void MapBuilder::getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const {
  const Impl::Lock lock(impl_->lock);
  const mrpt::system::CTimeLoggerEntry entry(impl_->profiler, "get_as_3d_object");
  if (!outObj) outObj = CSetOfObjects::Create();
  outObj->clear();
  const auto quantiles = static_cast<float>(impl_->options.quantiles_3D_representation);
  for (const core::MapLandmark& landmark : impl_->navigator->map()) {
    const bool mature = landmark.state == core::LandmarkState::mature;
    auto drawn = ellipse(landmark.point, quantiles, mature ? mature_colour : tentative_colour);
    drawn->setName("LM_" + std::to_string(impl_->number_of(landmark.id)));
    outObj->insert(drawn);
    if (mature) {
      add_text(*outObj, std::to_string(impl_->number_of(landmark.id)), landmark.point.mean_m, mature_colour);
    }
  }
  add_path(*outObj, impl_->path);
  const core::PoseGaussian pose = impl_->navigator->pose();
  add_vehicle(*outObj, pose, quantiles);
  const bool searching = impl_->last && impl_->last->mode == core::Mode::searching;
  if (searching) add_particles(*outObj, impl_->last->cloud);
  add_text(*outObj, searching ? "searching for old ground" : "mapping", pose.mean.position_m(), vehicle_colour);
}

}  // namespace helixnav::mrpt_adapter
