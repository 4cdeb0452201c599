// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_scene.hpp"

#include <algorithm>
#include <cmath>

#include <mrpt/img/CImage.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/opengl/CCamera.h>
#include <mrpt/opengl/CFBORender.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

constexpr unsigned width_px = 1000;
constexpr unsigned height_px = 800;

struct Extent {
  Eigen::Vector2d low_m;
  Eigen::Vector2d high_m;
};

Extent extent_of(const mrpt_adapter::MapBuilder& builder) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, std::int64_t> ids;
  mrpt::math::CVectorDouble state;
  builder.getCurrentState(pose, points, ids, state);
  Extent extent{{pose.mean.x(), pose.mean.y()}, {pose.mean.x(), pose.mean.y()}};
  for (const mrpt::math::TPoint2D& point : points) {
    extent.low_m = extent.low_m.cwiseMin(Eigen::Vector2d(point.x, point.y));
    extent.high_m = extent.high_m.cwiseMax(Eigen::Vector2d(point.x, point.y));
  }
  return extent;
}

}  // namespace

std::shared_ptr<mrpt::opengl::COpenGLScene> scene_of(const mrpt_adapter::MapBuilder& builder,
                                                     const std::vector<Eigen::Vector2d>& true_path_m) {
  auto scene = mrpt::opengl::COpenGLScene::Create();
  const Extent extent = extent_of(builder);
  constexpr double cell_m = 5.0;
  const Eigen::Vector2d low_m = (extent.low_m.array() / cell_m).floor() * cell_m - cell_m;
  const Eigen::Vector2d high_m = (extent.high_m.array() / cell_m).ceil() * cell_m + cell_m;
  auto grid = mrpt::opengl::CGridPlaneXY::Create(static_cast<float>(low_m.x()), static_cast<float>(high_m.x()),
                                                 static_cast<float>(low_m.y()), static_cast<float>(high_m.y()), 0.0F,
                                                 static_cast<float>(cell_m));
  grid->setColor(0.8F, 0.8F, 0.8F);
  scene->insert(grid);
  auto built = mrpt::opengl::CSetOfObjects::Create();
  builder.getAs3DObject(built);
  scene->insert(built);
  if (true_path_m.size() > 1) {
    auto line = mrpt::opengl::CSetOfLines::Create();
    line->setColor(0.0F, 0.0F, 0.0F);
    for (std::size_t i = 1; i < true_path_m.size(); ++i) {
      line->appendLine(true_path_m[i - 1].x(), true_path_m[i - 1].y(), 0.0, true_path_m[i].x(), true_path_m[i].y(),
                       0.0);
    }
    scene->insert(line);
  }
  return scene;
}

void render_png(const mrpt_adapter::MapBuilder& builder, mrpt::opengl::COpenGLScene& scene, const std::string& path) {
  const Extent extent = extent_of(builder);
  const Eigen::Vector2d size_m = extent.high_m - extent.low_m;
  const Eigen::Vector2d centre_m = (extent.high_m + extent.low_m) / 2.0;
  constexpr double margin = 1.15;
  constexpr double zoom_of_height = 2.0;  // MRPT shows half of the zoom distance
  constexpr double aspect = static_cast<double>(width_px) / height_px;
  mrpt::opengl::CCamera camera;
  camera.setProjectiveModel(false);
  camera.setPointingAt(static_cast<float>(centre_m.x()), static_cast<float>(centre_m.y()), 0.0F);
  camera.setAzimuthDegrees(-90.0F);  // x to the right, y up
  camera.setElevationDegrees(90.0F);
  camera.setZoomDistance(
      static_cast<float>(zoom_of_height * margin * std::max({size_m.x() / aspect, size_m.y(), 1.0})));
  scene.getViewport()->setCustomBackgroundColor({1.0F, 1.0F, 1.0F, 1.0F});

  mrpt::opengl::CFBORender renderer(width_px, height_px);
  renderer.setCamera(scene, camera);
  mrpt::img::CImage image(width_px, height_px, mrpt::img::CH_RGB);
  renderer.render_RGB(scene, image);
  if (!image.saveToFile(path)) throw core::InputError(path + ": the picture cannot be written");
}

}  // namespace helixnav::apps
