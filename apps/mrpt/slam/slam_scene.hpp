// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/mrpt_adapter/map_builder.hpp"

namespace mrpt::opengl {
class COpenGLScene;
}

namespace helixnav::apps {

/// What is shown: grid, map, path and vehicle of the builder, and the true path (black) if one is given.
std::shared_ptr<mrpt::opengl::COpenGLScene> scene_of(const mrpt_adapter::MapBuilder& builder,
                                                     const std::vector<Eigen::Vector2d>& true_path_m);

/// Renders the whole map from above, off screen, without X server (mrpt::opengl::CFBORender, EGL). Throws what MRPT
/// throws if there is no EGL; core::InputError if the file cannot be written. 0.2 s, mostly for loading the graphics
/// driver. Test: mrpt_apps/slam_test.cpp (the pixels of the landmarks).
void render_png(const mrpt_adapter::MapBuilder& builder, mrpt::opengl::COpenGLScene& scene, const std::string& path);

}  // namespace helixnav::apps
