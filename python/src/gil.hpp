// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

#include "bind.hpp"

namespace helixnav::python {

/// For a thread that comes back from our code when the interpreter has ended: CPython before 3.14 ends it there by unwinding it
/// (pthread_exit), which C++ answers with the end of the process, as destructors and handlers stand in the way. As from 3.14 on, it
/// waits in place of that, until the process is over.
[[noreturn]] inline void wait_for_the_end() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Once the interpreter has ended, its state is gone, and asking for the GIL would read freed memory. May be asked without the GIL.
inline void wait_if_python_has_ended() {
  if (Py_IsInitialized() == 0) wait_for_the_end();
}

/// Without the GIL in a scope, or in a call as py::call_guard.
class WithoutGil {
 public:
  WithoutGil() : thread_(PyEval_SaveThread()) {}
  ~WithoutGil() {
    wait_if_python_has_ended();
    try {
      PyEval_RestoreThread(thread_);
    } catch (...) {  // the unwinding itself
      wait_for_the_end();
    }
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* thread_;
};

/// With it again, in the midst of that.
class WithGil {
 public:
  WithGil() : state_(acquired()) {}
  ~WithGil() { PyGILState_Release(state_); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  static PyGILState_STATE acquired() {
    wait_if_python_has_ended();
    try {
      return PyGILState_Ensure();
    } catch (...) {
      wait_for_the_end();
    }
  }

  PyGILState_STATE state_;
};

}  // namespace helixnav::python
