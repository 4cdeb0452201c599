// SPDX-License-Identifier: BSD-3-Clause
// A call that throws leaves everything as it was: tested by failing allocations at many points in scans of every kind.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <new>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "pauses.hpp"
#include "placing/displaced_map.hpp"
#include "systematic/with_errors.hpp"
#include "wrong_names.hpp"

namespace {

constexpr long never = std::numeric_limits<long>::max();
thread_local long allocations_left = never;  ///< until one fails; those after it succeed again

void* allocate(std::size_t bytes) {
  if (allocations_left != never && --allocations_left < 0) {
    allocations_left = never;
    throw std::bad_alloc();
  }
  void* memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes); }
void* operator new[](std::size_t bytes) { return allocate(bytes); }
// Temporary buffers of the standard library: freed by the same delete as all others, and never the ones that fail.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes == 0 ? 1 : bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes == 0 ? 1 : bytes); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace helixnav::supervisor {
namespace {

/// Makes the call with allocation number `allocation` failing; true if the call threw.
template <class Call>
bool fails_at(long allocation, const Call& call) {
  allocations_left = allocation;
  try {
    call();
    allocations_left = never;
    return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
}

template <class Call>
long allocations_of(const Call& call) {
  constexpr long many = 1'000'000'000;
  allocations_left = many;
  call();
  return many - std::exchange(allocations_left, never);
}

constexpr double same_m = 1e-12;

void expect_same_map(const std::vector<core::MapLandmark>& a, const std::vector<core::MapLandmark>& b,
                     double rounding_m = same_m) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].state, b[i].state);
    EXPECT_EQ(a[i].observations, b[i].observations);
    EXPECT_EQ(a[i].appearance.votes.front().name, b[i].appearance.votes.front().name);
    EXPECT_EQ(a[i].appearance.votes.front().nats, b[i].appearance.votes.front().nats);
    EXPECT_EQ(a[i].appearance.size_m, b[i].appearance.size_m);
    EXPECT_EQ(a[i].appearance.size_variance_m2, b[i].appearance.size_variance_m2);
    EXPECT_LT((a[i].point.mean_m - b[i].point.mean_m).norm(), rounding_m);
    EXPECT_LT((a[i].point.covariance_m2 - b[i].point.covariance_m2).norm(), 1e-9 * b[i].point.covariance_m2.norm());
  }
}

void expect_same_report(const core::StepReport& a, const core::StepReport& b, double rounding_m = same_m) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_LT((a.pose.mean.vector() - b.pose.mean.vector()).norm(), rounding_m);
  EXPECT_LE((a.pose.covariance - b.pose.covariance).norm(), 1e-9 * b.pose.covariance.norm());
  EXPECT_EQ(a.mapped_landmarks, b.mapped_landmarks);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.decisions.size(), b.decisions.size());
  ASSERT_EQ(a.associations.size(), b.associations.size());
  for (std::size_t i = 0; i < a.associations.size(); ++i) {
    EXPECT_EQ(a.associations[i].outcome, b.associations[i].outcome);
    EXPECT_EQ(a.associations[i].landmark, b.associations[i].landmark);
  }
}

NavigatorOptions single_threaded(std::uint64_t seed) {
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  options.search.seed = seed;
  return options;
}

/// What a scan did that is worth breaking.
enum class Kind {
  mapping,
  trigger,
  searching,
  closing,
  rollback,
  place_without_search,
  carried,
  parted,
  placed_again,
  systematic,
  lost_by_slip
};

Kind kind_of(const core::StepReport& report) {
  const bool was_searching = report.mode == core::Mode::searching;
  for (const core::Decision& decision : report.decisions) {
    if (std::holds_alternative<core::SystematicDecision>(decision)) return Kind::systematic;
    if (std::holds_alternative<core::LostBySlipDecision>(decision)) return Kind::lost_by_slip;
    const auto* asked = std::get_if<core::WholeMapDecision>(&decision);
    const bool found = asked != nullptr && asked->verdict == core::WholeMapDecision::Verdict::accepted;
    if (found && !was_searching) return Kind::place_without_search;
    const auto* carried = std::get_if<core::CarriedDecision>(&decision);
    const bool is_parted = carried != nullptr && carried->cause == core::CarriedDecision::Cause::by_place;
    const bool is_wrong = carried != nullptr && carried->cause == core::CarriedDecision::Cause::wrong_place;
    if (is_wrong) return Kind::placed_again;
    if (carried != nullptr) return is_parted ? Kind::parted : Kind::carried;
    const auto* closure = std::get_if<core::ClosureDecision>(&decision);
    if (closure != nullptr && closure->accepted) return Kind::closing;
    if (std::holds_alternative<core::RollbackDecision>(decision)) return Kind::rollback;
    if (std::holds_alternative<core::TriggerDecision>(decision)) return Kind::trigger;
  }
  return was_searching ? Kind::searching : Kind::mapping;
}

/// Drives twice; the second time, scans of each kind are broken at `places` allocations each, spread over all those of
/// the scan, and then go on as in the first drive. Returns the kinds that were broken.
std::set<Kind> break_drive(const core::Recording& run, const NavigatorOptions& options, int places,
                           double rounding_m = same_m, const core::JointMap* earlier = nullptr) {
  std::vector<core::StepReport> reports;
  std::vector<long> allocations;
  Navigator first(run.start, options);
  if (earlier != nullptr) first.look_for_place_in(*earlier);
  drive(run, first, [&](const core::Scan& scan, std::size_t) {
    core::StepReport report;
    allocations.push_back(allocations_of([&] { report = first.observe(scan); }));
    reports.push_back(std::move(report));
  });
  std::set<Kind> broken;
  Navigator second(run.start, options);
  if (earlier != nullptr) second.look_for_place_in(*earlier);
  drive(run, second, [&](const core::Scan& scan, std::size_t i) {
    const Kind kind = kind_of(reports[i]);
    const bool is_early = i <= 120 && kind != Kind::placed_again;
    const bool worth_breaking = !is_early && (kind != Kind::mapping || i % 60 == 0) && broken.count(kind) == 0;
    if (!worth_breaking) {
      expect_same_report(second.observe(scan), reports[i], rounding_m);
      return;
    }
    broken.insert(kind);
    const core::PoseGaussian before = second.pose();
    const std::vector<core::MapLandmark> map_before = second.map();
    const long spread = allocations[i];
    for (int k = 0; k < places; ++k) {
      const long at = std::min(spread - 1, k * spread / places + (k % 3));
      if (!fails_at(at, [&] { second.observe(scan); })) {
        ADD_FAILURE() << "allocation " << at << " of " << spread << " did not fail";
        return;
      }
      EXPECT_EQ(second.pose().mean.vector(), before.mean.vector()) << "allocation " << at << " of " << spread;
      EXPECT_EQ(second.pose().covariance, before.covariance);
      expect_same_map(second.map(), map_before, rounding_m);
    }
    expect_same_report(second.observe(scan), reports[i], rounding_m);
  });
  return broken;
}

TEST(Guarantee, AScanThatThrowsLeavesTheNavigatorAsItWasWhereverItBreaks) {
  const core::Recording run = sim::simulate(sim::named_scenario("large-loop-changed"), 3);
  const std::set<Kind> broken = break_drive(run, single_threaded(3), 12);
  for (const Kind kind : {Kind::mapping, Kind::trigger, Kind::searching, Kind::closing}) {
    EXPECT_EQ(broken.count(kind), 1u) << static_cast<int>(kind);
  }
}

TEST(Guarantee, HoldsForClassesAndSizes) {
  sim::Scenario scenario = sim::named_scenario("large-loop-changed");
  scenario.scanner.looks.classes = 4;
  scenario.scanner.looks.class_error = 0.05;
  scenario.scanner.looks.sigma_size_m = 0.05;
  const std::set<Kind> broken = break_drive(sim::simulate(scenario, 3), single_threaded(3), 12);
  for (const Kind kind : {Kind::mapping, Kind::trigger, Kind::searching, Kind::closing}) {
    EXPECT_EQ(broken.count(kind), 1u) << static_cast<int>(kind);
  }
}

TEST(Guarantee, HoldsWhereTheFilterHoldsAPartOfTheMap) {
  const core::Recording run = sim::simulate(sim::named_scenario("large-loop-changed"), 3);
  NavigatorOptions options = single_threaded(3);
  options.map.whole = options.map.window = 30;
  const std::set<Kind> broken = break_drive(run, options, 12);
  for (const Kind kind : {Kind::mapping, Kind::trigger, Kind::searching, Kind::closing}) {
    EXPECT_EQ(broken.count(kind), 1u) << static_cast<int>(kind);
  }
}

TEST(Guarantee, HoldsWhereSystematicErrorsAreTakenOutOfTheDrive) {
  SystematicErrors errors;
  errors.too_long = 0.04;
  errors.short_m = 0.3;
  const core::Recording run = with_errors(sim::simulate(sim::named_scenario("large-loop"), 3), errors);
  EXPECT_EQ(break_drive(run, single_threaded(3), 12).count(Kind::systematic), 1u);
}

TEST(Guarantee, HoldsInARollBack) {
  const core::Recording run = sim::simulate(sim::named_scenario("sparse"), 2199);
  EXPECT_EQ(break_drive(run, single_threaded(2199), 6).count(Kind::rollback), 1u);
}

TEST(Guarantee, HoldsWhereThePlaceOfACarriedVehicleIsFoundWithoutASearch) {
  sim::Scenario scenario = sim::named_scenario("kidnapped");
  scenario.world.tour_m = 2600.0;
  const core::Recording run = without_waiting(sim::simulate(scenario, 3004));
  // Hundreds of metres from the start, and a phase may be absorbed at another point than when undisturbed.
  constexpr double rounding_m = 1e-9;
  NavigatorOptions without_slips = single_threaded(1);
  without_slips.slip.enabled = false;  // else a search begins as soon as everything has vanished
  EXPECT_EQ(break_drive(run, without_slips, 6, rounding_m).count(Kind::place_without_search), 1u);
}

TEST(Guarantee, HoldsWhereEverythingHasVanishedAndASearchBegins) {
  sim::Scenario scenario = sim::named_scenario("kidnapped");
  scenario.world.tour_m = 2600.0;
  const core::Recording run = without_waiting(sim::simulate(scenario, 3004));
  constexpr double rounding_m = 1e-9;  // as above
  EXPECT_EQ(break_drive(run, single_threaded(1), 12, rounding_m).count(Kind::lost_by_slip), 1u);
}

TEST(Guarantee, HoldsWhereItIsFoundOutThatTheVehicleWasCarried) {
  const core::Recording run = with_pauses(sim::simulate(wide_circuit(), 1), {{220, 290}}, false);
  EXPECT_EQ(break_drive(run, single_threaded(1), 12).count(Kind::carried), 1u);
}

TEST(Guarantee, HoldsWhereTheDriveIsPartedAtAPause) {
  const core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3400054);
  constexpr double rounding_m = 1e-9;  // as above
  EXPECT_EQ(break_drive(run, single_threaded(1), 12, rounding_m).count(Kind::parted), 1u);
}

TEST(Guarantee, HoldsWhereAWrongPlaceIsUndone) {
  const DisplacedMap given = displaced_map(7);
  constexpr double rounding_m = 1e-9;  // as above
  EXPECT_EQ(break_drive(given.today, single_threaded(1), 12, rounding_m, &given.earlier).count(Kind::placed_again), 1u);
}

TEST(Guarantee, HoldsForFixes) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  const core::PoseGaussian before = navigator.pose();
  core::Odometry motion = core::Odometry{};
  motion.T_before_after = core::Pose2(1.0, 0.0, 0.1);
  motion.covariance = 0.01 * Eigen::Matrix3d::Identity();
  navigator.move(motion);
  core::AbsoluteFix fix;
  fix.position_world_m = before.mean.position_m();
  long at = 0;
  while (fails_at(at, [&] { navigator.fix(fix); })) {
    EXPECT_EQ(navigator.pose().mean.vector(), before.mean.vector());
    ++at;
  }
  EXPECT_GT(at, 0);
  EXPECT_GT((navigator.pose().mean.vector() - before.mean.vector()).norm(), 0.01) << "the motion was not lost";
}

TEST(Guarantee, HoldsWhereTheVehicleIsSaidToHaveBeenCarried) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  Navigator twin(run.start);
  Navigator navigator(run.start);
  std::size_t scans = 0;
  bool found = false;
  for (const core::Event& event : run.events) {
    const bool is_scan = std::holds_alternative<core::Scan>(event);
    if (is_scan && ++scans == 230) {
      twin.lose({});
      const core::PoseGaussian before = navigator.pose();
      const std::vector<core::MapLandmark> map_before = navigator.map();
      long at = 0;
      for (; fails_at(at, [&] { navigator.lose({}); }); ++at) {
        EXPECT_EQ(navigator.pose().mean.vector(), before.mean.vector());
        expect_same_map(navigator.map(), map_before);
        EXPECT_TRUE(navigator.maps_apart().empty());
      }
      EXPECT_GT(at, 20);
      EXPECT_EQ(navigator.maps_apart().size(), 1u);
    }
    const auto expected = twin.take(event);
    if (!is_scan || found || scans < 230) {
      const auto report = navigator.take(event);
      if (report) expect_same_report(*report, *expected);
      continue;
    }
    const auto& placed = expected->decisions;
    found = std::any_of(placed.begin(), placed.end(), [](const core::Decision& decision) {
      const auto* place = std::get_if<core::PlacedDecision>(&decision);
      return place != nullptr && place->verdict == core::PlacedDecision::Verdict::accepted;
    });
    for (long at = 0; fails_at(at, [&] { expect_same_report(*navigator.take(event), *expected); }); at += 1 + at) {
    }
  }
  EXPECT_TRUE(found);
  expect_same_map(navigator.map(), twin.map());
}

/// How many calls of a drive by name were broken, and how many of those began a window.
struct BrokenByName {
  int calls = 0;
  int hand_overs = 0;
};

BrokenByName break_named_drive(const core::Recording& run, const NavigatorOptions& options, std::size_t every) {
  NamedNavigator twin(run.start, options);
  NamedNavigator navigator(run.start, options);
  BrokenByName broken;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) {
      twin.take(event, {});
      navigator.take(event, {});
      continue;
    }
    const std::vector<core::Label>& labels = run.labels[scans];
    long spread = 0;
    std::vector<core::MapLandmark> before;
    NamedNavigator counted = navigator;
    const long allocations = allocations_of([&] { counted.observe(*scan, labels); });
    const bool begins_window = counted.filter().next_name() < navigator.filter().next_name();
    if (scans % every == 11 || (begins_window && broken.hand_overs < 3)) {
      before = navigator.map();
      spread = allocations;
      broken.hand_overs += begins_window ? 1 : 0;
    }
    for (long at = 0; at < spread; at += 1 + at / 5) {
      NamedNavigator victim = navigator;
      if (!fails_at(at, [&] { victim.observe(*scan, labels); })) continue;
      EXPECT_EQ(victim.pose().mean.vector(), navigator.pose().mean.vector());
      expect_same_map(victim.map(), before);
      expect_same_report(victim.observe(*scan, labels), NamedNavigator(navigator).observe(*scan, labels));
      ++broken.calls;
    }
    expect_same_report(navigator.observe(*scan, labels), twin.observe(*scan, labels));
    ++scans;
  }
  expect_same_map(navigator.map(), twin.map());
  return broken;
}

TEST(Guarantee, HoldsForObservationsKnownByName) {
  EXPECT_GT(break_named_drive(sim::simulate(wide_circuit(), 5), {}, 37).calls, 50);
}

TEST(Guarantee, HoldsForNamesThatAreWrong) {
  const core::Recording run = with_a_wrong_first_name(with_wrong_names(sim::simulate(wide_circuit(), 5), 0.03, 5));
  EXPECT_GT(break_named_drive(run, {}, 37).calls, 50);
}

TEST(Guarantee, HoldsWhereTheFilterHoldsAPartOfAMapKnownByName) {
  NavigatorOptions options;
  options.map.whole = options.map.window = 6;
  options.map.most = 8;
  const BrokenByName broken = break_named_drive(sim::simulate(wide_circuit(), 5), options, 23);
  EXPECT_GT(broken.calls, 50);
  EXPECT_GE(broken.hand_overs, 2);
}

TEST(Guarantee, WhatNoEventMayHoldIsRefusedAtTheDoor) {
  Navigator navigator{core::PoseGaussian{}};
  NamedNavigator named{core::PoseGaussian{}};
  core::Odometry lost;
  lost.T_before_after.x_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(navigator.move(lost), core::PreconditionError);
  EXPECT_THROW(named.move(lost), core::PreconditionError);
  core::Scan scan;
  scan.field_of_view.max_range_m = 30.0;
  scan.observations = {core::make_range_bearing(10.0, 0.1, 0.1, 0.02), core::make_range_bearing(12.0, 0.5, 0.1, 0.02)};
  scan.observations.back().z[0] = -12.0;
  EXPECT_THROW(navigator.observe(scan), core::PreconditionError);
  EXPECT_THROW(named.observe(scan, {1, 2}), core::PreconditionError);
  EXPECT_EQ(navigator.filter().mapped_count(), 0) << "the good one before it left no landmark";
  EXPECT_EQ(named.filter().mapped_count(), 0);
  scan.observations.back().z[0] = 12.0;
  for (int k = 0; k < 3; ++k) EXPECT_EQ(navigator.observe(scan).step, k);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(named.observe(scan, {1, 2}).mapped_landmarks, 2);
}

}  // namespace
}  // namespace helixnav::supervisor
