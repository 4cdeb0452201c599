// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/event_loop.hpp"

#include <string>
#include <variant>

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

/// Records what it takes; answers scans with a number of its own.
struct Scribe {
  std::string taken;

  std::optional<StepReport> take(const Event& event) {
    taken += "osf"[event.index()];
    if (!std::holds_alternative<Scan>(event)) return std::nullopt;
    StepReport report;
    report.step = 77;
    report.t_ns = time_of(event);
    return report;
  }
};

std::vector<Event> two_scans() {
  Scan first;
  first.t_ns = 5;
  Scan second;
  second.t_ns = 9;
  return {Odometry{}, Odometry{}, first, AbsoluteFix{}, second, Odometry{}};
}

TEST(EventLoop, FeedsEveryEventOnceAndInOrder) {
  const std::vector<Event> events = two_scans();
  Scribe scribe;
  EventLoop loop(events, scribe);
  const auto first = loop.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->t_ns, 5);
  EXPECT_EQ(scribe.taken, "oos") << "nothing behind the scan is fed before its step was looked at";
  EXPECT_EQ(loop.fed(), 3u);
  ASSERT_TRUE(loop.next());
  EXPECT_FALSE(loop.next());
  EXPECT_EQ(scribe.taken, "oosfso") << "what follows the last scan is fed, too";
  EXPECT_FALSE(loop.next());
  EXPECT_EQ(scribe.taken, "oosfso");
}

TEST(EventLoop, NumbersTheStepsItself) {
  const std::vector<Event> events = two_scans();
  Scribe scribe;
  EventLoop loop(events, scribe);
  EXPECT_EQ(loop.next()->step, 0);
  EXPECT_EQ(loop.next()->step, 1);
  EXPECT_EQ(loop.steps(), 2);
}

TEST(EventLoop, NumbersTheStepsOfTheNextPartOnFromThoseBefore) {
  const std::vector<Event> events = two_scans();
  Scribe scribe;
  EventLoop loop(events, scribe, 5);
  EXPECT_EQ(loop.next()->step, 5);
  EXPECT_EQ(loop.next()->step, 6);
  EXPECT_EQ(loop.steps(), 7);
}

TEST(EventLoop, OfNoEventsMakesNoStep) {
  const std::vector<Event> events;
  Scribe scribe;
  EXPECT_FALSE(EventLoop(events, scribe).next());
}

/// Throws at the third scan.
struct Fragile {
  int scans = 0;
  std::optional<StepReport> take(const Event& event) {
    if (!std::holds_alternative<Scan>(event)) return std::nullopt;
    if (++scans == 3) throw NumericalError("S is not positive definite");
    return StepReport{};
  }
};

TEST(EventLoop, NamesStepAndTimeOfABreakdown) {
  std::vector<Event> events;
  for (int k = 0; k < 5; ++k) {
    Scan scan;
    scan.t_ns = core::Nanoseconds{1'500'000'000} * k;
    events.emplace_back(scan);
  }
  Fragile fragile;
  EventLoop loop(events, fragile);
  loop.next();
  loop.next();
  try {
    loop.next();
    FAIL() << "nothing thrown";
  } catch (const NumericalError& error) {
    EXPECT_STREQ(error.what(), "step 2, t = 3.000000 s: S is not positive definite");
  }
}

}  // namespace
}  // namespace helixnav::core
