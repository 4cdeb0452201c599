// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <utility>

#include "bind.hpp"

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
