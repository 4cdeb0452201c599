// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

namespace mrpt::opengl {
class COpenGLScene;
}

namespace helixnav::apps {

/// A window that follows a run.
class LiveWindow {
 public:
  virtual ~LiveWindow() = default;
  virtual bool is_open() const = 0;
  virtual void show(const std::shared_ptr<mrpt::opengl::COpenGLScene>& scene, const std::string& text) = 0;
  virtual void look_at(double x_m, double y_m) = 0;
};

/// Loads the window's library, which stands beside the program or in ../lib/helixnav, and opens one: that brings wxWidgets
/// in, 0.2 s that a run without window need not pay. Null with the reason in `why_not` when there is no display or no
/// library.
std::unique_ptr<LiveWindow> open_live_window(std::string& why_not);

}  // namespace helixnav::apps
