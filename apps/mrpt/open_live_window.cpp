// SPDX-License-Identifier: BSD-3-Clause
#include <dlfcn.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <system_error>

#include "live_window.hpp"

namespace helixnav::apps {
namespace {

constexpr const char* library = "helixnav-live-window.so";

void* load(std::string& why_not) {
  std::error_code unknown;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  for (const std::filesystem::path& place : {here / library, here / ".." / HELIXNAV_LIVE_WINDOW_DIR / library}) {
    if (!std::filesystem::exists(place, unknown)) continue;
    if (void* loaded = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL)) return loaded;
    why_not = dlerror();
    return nullptr;
  }
  why_not = std::string(library) + " is not installed";
  return nullptr;
}

}  // namespace

std::unique_ptr<LiveWindow> open_live_window(std::string& why_not) {
  if (std::getenv("DISPLAY") == nullptr) {  // wxWidgets ends the program when it finds none
    why_not = "there is no display";
    return nullptr;
  }
  void* loaded = load(why_not);
  if (loaded == nullptr) return nullptr;
  using Open = LiveWindow* (*)();
  const auto open = reinterpret_cast<Open>(dlsym(loaded, "helixnav_open_live_window"));
  if (open == nullptr) {
    why_not = dlerror();
    return nullptr;
  }
  try {
    return std::unique_ptr<LiveWindow>(open());
  } catch (const std::exception& error) {
    why_not = error.what();
    return nullptr;
  }
}

}  // namespace helixnav::apps
