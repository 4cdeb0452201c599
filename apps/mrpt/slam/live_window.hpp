// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

namespace mrpt::gui {
class CDisplayWindow3D;
}
namespace mrpt::opengl {
class COpenGLScene;
}

namespace helixnav::apps {

/// A window that follows a run.
class LiveWindow {
 public:
  LiveWindow();
  ~LiveWindow();
  LiveWindow(const LiveWindow&) = delete;
  LiveWindow& operator=(const LiveWindow&) = delete;

  bool is_open() const;
  void show(const std::shared_ptr<mrpt::opengl::COpenGLScene>& scene, const std::string& text);
  void look_at(double x_m, double y_m);

 private:
  std::shared_ptr<mrpt::gui::CDisplayWindow3D> window_;
};

/// Null with the reason in `why_not` when there is no display.
std::unique_ptr<LiveWindow> open_live_window(std::string& why_not);

}  // namespace helixnav::apps
