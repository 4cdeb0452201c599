// SPDX-License-Identifier: BSD-3-Clause
#include "slam/live_view.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include <mrpt/opengl/COpenGLScene.h>

#include "helixnav/mrpt_adapter/run_access.hpp"
#include "slam/slam_scene.hpp"

namespace helixnav::apps {
namespace {

using LiveClock = std::chrono::steady_clock;

double since(LiveClock::time_point begin) { return std::chrono::duration<double>(LiveClock::now() - begin).count(); }

}  // namespace

LiveView::LiveView(const SlamConfig& config) : follows_robot_(config.CAMERA_3DSCENE_FOLLOWS_ROBOT) {
  if (!config.SHOW_3D_LIVE) return;
  std::string why_not;
  window_ = open_live_window(why_not);
  if (!window_) std::fprintf(stderr, "helixnav-slam: no live view: %s\n", why_not.c_str());
}

void LiveView::show(const mrpt_adapter::MapBuilder& builder, std::size_t step, bool must) {
  if (!window_ || !window_->is_open() || (!must && shown_ && since(*shown_) < pause_s_)) return;
  const LiveClock::time_point begin = LiveClock::now();
  window_->show(scene_of(builder, {}), "Step " + std::to_string(step));
  const core::Pose2 pose = mrpt_adapter::RunAccess::pose(builder).mean;
  if (follows_robot_) window_->look_at(pose.x_m, pose.y_m);
  pause_s_ = std::max(0.05, 9.0 * since(begin));
  shown_ = LiveClock::now();
}

}  // namespace helixnav::apps
