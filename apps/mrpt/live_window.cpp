// SPDX-License-Identifier: BSD-3-Clause
//
// The library that open_live_window loads; all of wxWidgets hangs on it.
#include "live_window.hpp"

#include <chrono>
#include <thread>

#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/opengl/COpenGLScene.h>

namespace helixnav::apps {
namespace {

class DisplayWindow : public LiveWindow {
 public:
  DisplayWindow() : window_(mrpt::gui::CDisplayWindow3D::Create("helixnav-slam", 800, 600)) {
    window_->setCameraZoom(80.0F);
    window_->setCameraElevationDeg(70.0F);
    window_->captureImagesStart();
  }

  /// A software renderer takes a second or two for its first picture. Who closes the window before, and ends the program,
  /// takes the renderer's compiler away from under it.
  ~DisplayWindow() override {
    using namespace std::chrono_literals;
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (window_->isOpen() && !window_->getLastWindowImagePtr() && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(10ms);
    }
  }

  bool is_open() const override { return window_->isOpen(); }

  void show(const std::shared_ptr<mrpt::opengl::COpenGLScene>& scene, const std::string& text) override {
    window_->get3DSceneAndLock() = scene;
    window_->addTextMessage(0.02, 0.02, text, 0);
    window_->unlockAccess3DScene();
    window_->repaint();
  }

  void look_at(double x_m, double y_m) override {
    window_->setCameraPointingToPoint(static_cast<float>(x_m), static_cast<float>(y_m), 0.0F);
  }

 private:
  mrpt::gui::CDisplayWindow3D::Ptr window_;
};

}  // namespace
}  // namespace helixnav::apps

extern "C" helixnav::apps::LiveWindow* helixnav_open_live_window() { return new helixnav::apps::DisplayWindow; }
