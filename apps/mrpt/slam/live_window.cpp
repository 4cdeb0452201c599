// SPDX-License-Identifier: BSD-3-Clause
#include "slam/live_window.hpp"

#include <chrono>
#include <cstdlib>
#include <exception>
#include <thread>

#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/opengl/COpenGLScene.h>

namespace helixnav::apps {

LiveWindow::LiveWindow() : window_(mrpt::gui::CDisplayWindow3D::Create("helixnav-slam", 800, 600)) {
  window_->setCameraZoom(80.0F);
  window_->setCameraElevationDeg(70.0F);
  window_->captureImagesStart();
}

/// A software renderer takes a second or two for its first picture. Closing the window earlier, and ending the program,
/// would pull the renderer's compiler out from under it.
LiveWindow::~LiveWindow() {
  using namespace std::chrono_literals;
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (window_->isOpen() && !window_->getLastWindowImagePtr() && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(10ms);
  }
}

bool LiveWindow::is_open() const { return window_->isOpen(); }

void LiveWindow::show(const std::shared_ptr<mrpt::opengl::COpenGLScene>& scene, const std::string& text) {
  window_->get3DSceneAndLock() = scene;
  window_->addTextMessage(0.02, 0.02, text, 0);
  window_->unlockAccess3DScene();
  window_->repaint();
}

void LiveWindow::look_at(double x_m, double y_m) {
  window_->setCameraPointingToPoint(static_cast<float>(x_m), static_cast<float>(y_m), 0.0F);
}

std::unique_ptr<LiveWindow> open_live_window(std::string& why_not) {
  if (std::getenv("DISPLAY") == nullptr) {  // wxWidgets ends the program if it finds none
    why_not = "there is no display";
    return nullptr;
  }
  try {
    return std::make_unique<LiveWindow>();
  } catch (const std::exception& error) {
    why_not = error.what();
    return nullptr;
  }
}

}  // namespace helixnav::apps
