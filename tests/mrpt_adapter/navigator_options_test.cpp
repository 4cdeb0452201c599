// SPDX-License-Identifier: BSD-3-Clause
#include "navigator_options.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::mrpt_adapter {
namespace {

/// The search that results from keys of [HelixNav].
supervisor::SearchOptions search_of(const std::string& lines) {
  MapBuilderOptions options;
  options.loadFromConfigFile(mrpt::config::CConfigFileMemory("[HelixNav]\n" + lines), "HelixNav");
  return navigator_options(options).search;
}

TEST(SearchKeys, LeaveTheSearchAsItIsWhenTheyAreNotThere) {
  const supervisor::SearchOptions search = search_of("");
  const supervisor::SearchOptions defaults;
  EXPECT_EQ(search.reach_m, defaults.reach_m);
  EXPECT_EQ(search.extraneous_per_scan, defaults.extraneous_per_scan);
  EXPECT_EQ(search.relocalizer.sensor.extraneous_per_scan, defaults.relocalizer.sensor.extraneous_per_scan);
  EXPECT_EQ(search.rivals.extraneous_per_m2, defaults.rivals.extraneous_per_m2);
}

TEST(SearchKeys, ScaleMultipliesLengthsAndDividesDensities) {
  const supervisor::SearchOptions search = search_of("search_scale = 0.1\n");
  const supervisor::SearchOptions defaults;
  EXPECT_DOUBLE_EQ(search.reach_m, 0.1 * defaults.reach_m);
  EXPECT_DOUBLE_EQ(search.rivals.distinct_m, 0.1 * defaults.rivals.distinct_m);
  EXPECT_DOUBLE_EQ(search.rivals.extraneous_per_m2, 100.0 * defaults.rivals.extraneous_per_m2);
  EXPECT_EQ(search.extraneous_per_scan, defaults.extraneous_per_scan);
  EXPECT_DOUBLE_EQ(search.old_after_m, 0.1 * defaults.old_after_m);
  EXPECT_EQ(search_of("search_scale = 0.1\nsearch_old_after = 80\n").old_after_m, 80.0);
}

TEST(SearchKeys, ExtraneousObservationsReachTheDecisionsAndTheParticles) {
  const supervisor::SearchOptions search = search_of("search_extraneous_per_scan = 0.75\n");
  EXPECT_EQ(search.extraneous_per_scan, 0.75);
  EXPECT_EQ(search.relocalizer.sensor.extraneous_per_scan, 0.75);
  EXPECT_EQ(search.rivals.extraneous_per_m2, supervisor::SearchOptions{}.rivals.extraneous_per_m2);
}

TEST(SearchKeys, TheNameOfEarlierVersionsCountsUnlessTheNewOneIsThere) {
  EXPECT_EQ(search_of("search_foreign_per_scan = 0.75\n").extraneous_per_scan, 0.75);
  EXPECT_EQ(search_of("search_foreign_per_scan = 0.75\nsearch_extraneous_per_scan = 2\n").extraneous_per_scan, 2.0);
}

TEST(SearchKeys, ExtraneousObservationsAreFewerAmongReflectorsUnlessTheFileSaysIt) {
  EXPECT_EQ(search_of("detector = reflectors\n").extraneous_per_scan, 0.5);
  EXPECT_EQ(search_of("detector = reflectors\nsearch_extraneous_per_scan = 2\n").extraneous_per_scan, 2.0);
}

TEST(SearchKeys, ViewAreaSpreadsTheExtraneousObservationsWhateverTheScale) {
  EXPECT_DOUBLE_EQ(search_of("search_view_area = 50\n").rivals.extraneous_per_m2,
                   supervisor::SearchOptions{}.extraneous_per_scan / 50.0);
  const supervisor::SearchOptions search =
      search_of("search_scale = 0.1\nsearch_extraneous_per_scan = 0.5\nsearch_view_area = 5.6\n");
  EXPECT_DOUBLE_EQ(search.rivals.extraneous_per_m2, 0.5 / 5.6);
}

TEST(SearchKeys, AreRefusedWithSectionKeyAndValueOutOfTheirRange) {
  const std::vector<std::pair<std::string, std::string>> bad{
      {"search_scale", "0"},       {"search_scale", "1001"},
      {"search_scale", "far"},     {"search_extraneous_per_scan", "-0.1"},
      {"search_view_area", "-1"},  {"search_extraneous_per_scan", "101"},
      {"search_view_area", "inf"}, {"search_view_area", "5.6 m2"}};
  for (const auto& [key, value] : bad) {
    try {
      search_of(key + " = " + value + "\n");
      ADD_FAILURE() << key << " = " << value << " was taken";
    } catch (const core::InputError& error) {
      const std::string wanted = "[HelixNav] " + key + " = \"" + value + "\": expected a number from ";
      EXPECT_EQ(std::string(error.what()).rfind(wanted, 0), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
