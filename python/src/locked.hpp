// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "helixnav/runs/drive_digest.hpp"

namespace helixnav::python {

/// A navigator that threads call one after the other: without the GIL, which is released in a step, nothing else parts
/// them.
template <class AnyNavigator>
struct Locked {
  template <class... Arguments>
  explicit Locked(const Arguments&... arguments) : navigator(arguments...) {}

  explicit Locked(AnyNavigator&& begun) : navigator(std::move(begun)) {}

  AnyNavigator navigator;
  std::mutex mutex;
  runs::DriveDigest drive = {};                  ///< of the scans taken
  std::vector<std::string> earlier_drives = {};  ///< of the map that it goes on in, or looks for its place in
};

/// A method as a function of a Locked: to be called without the GIL, which a thread that waits would else keep.
template <class AnyNavigator, class Result, class... Arguments>
auto locked(Result (AnyNavigator::*method)(Arguments...)) {
  return [method](Locked<AnyNavigator>& self, Arguments... arguments) -> Result {
    const std::lock_guard hold(self.mutex);
    return (self.navigator.*method)(arguments...);
  };
}
template <class AnyNavigator, class Result>
auto locked(Result (AnyNavigator::*method)() const) {
  return [method](Locked<AnyNavigator>& self) -> Result {
    const std::lock_guard hold(self.mutex);
    return (self.navigator.*method)();
  };
}

}  // namespace helixnav::python
