// SPDX-License-Identifier: BSD-3-Clause
// A thread may still navigate while the process ends (a daemon thread of Python does): it must not need objects of
// static duration that are gone by then.
#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "judged_drive.hpp"

namespace helixnav::supervisor {
namespace {

/// A drive that closes its loop.
evaluation::RunScore large_loop() { return navigate_and_judge(sim::named_scenario("large-loop"), 1); }

evaluation::RunScore before_exit;

/// Registered before the first drive, so that it runs after the destructors of what that drive created on the way.
void drive_again() {
  evaluation::RunScore after;
  std::thread([&after] { after = large_loop(); }).join();  // this thread's own objects are gone, too
  const bool same = !after.closures.empty() && after.closures.size() == before_exit.closures.size() &&
                    after.map_rms_m == before_exit.map_rms_m;
  _exit(same ? 0 : 1);
}

TEST(AfterExit, NavigatesAsBefore) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        mallopt(M_PERTURB, 0xa5);  // freed memory holds nonsense
        std::atexit(drive_again);
        before_exit = large_loop();
        std::exit(2);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace helixnav::supervisor
