// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/chi2.hpp"
#include "helixnav/logs/dlr.hpp"
#include "program.hpp"
#include "real_data.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Convert : public testing::RealDataTest {
 protected:
  fs::path file(const std::string& name) const { return folder_.path() / name; }
  void must(const std::vector<std::string>& words) const {
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  void refused(const std::vector<std::string>& words, int exit_code, const std::string& word) const {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
  json smoothed(const std::string& name) const {
    must({"smooth", file(name), "--first-damping", "1e-8", "--out", file(name + ".run")});
    return json::parse(text_of(file(name + ".run") / "summary.json"));
  }
  fs::path small_log() const {
    std::ofstream(file("log.txt")) << circle_graph(30);
    return file("log.txt");
  }
  std::set<std::string> names() const { return names_in(folder_.path()); }

  testing::TemporaryFolder folder_;
};

TEST_F(Convert, LeavesTheOptimumOfDlrRunEWhereItIsThroughAllFormatsAndBack) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  must({"convert", path_, file("a.g2o")});
  must({"convert", file("a.g2o"), file("b.isam")});
  must({"convert", file("b.isam"), file("c.gtsam")});
  must({"convert", file("c.gtsam"), file("d.circles")});
  const json summary = smoothed("d.circles");
  EXPECT_NEAR(summary.at("chi2"), 56871.45, 0.01);
  EXPECT_EQ(summary.at("dof"), 27466);
}

TEST_F(Convert, GoesAroundAllFormatsAndBack) {
  must({"convert", small_log(), file("a.g2o")});
  must({"convert", file("a.g2o"), file("b.isam")});
  must({"convert", file("b.isam"), file("c.gtsam")});
  must({"convert", file("c.gtsam"), file("d.g2o")});
  const double chi2 = smoothed("log.txt").at("chi2");
  for (const char* name : {"a.g2o", "b.isam", "c.gtsam", "d.g2o"}) {
    EXPECT_NEAR(smoothed(name).at("chi2"), chi2, 1e-6 * chi2) << name;
  }
}

/// Checks the differences between both logs, in the numbers that `get` appends for each event, against the 99 %
/// interval of a standard deviation.
template <class Get>
void expect_noise(const core::Recording& before, const core::Recording& after, double sigma, const Get& get) {
  std::vector<double> a;
  std::vector<double> b;
  for (const core::Event& event : before.events) get(event, a);
  for (const core::Event& event : after.events) get(event, b);
  ASSERT_EQ(a.size(), b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (b[i] - a[i]) * (b[i] - a[i]);
  const auto n = static_cast<double>(a.size());
  EXPECT_GT(sum / (sigma * sigma), core::chi2_quantile(0.005, static_cast<int>(n)));
  EXPECT_LT(sum / (sigma * sigma), core::chi2_quantile(0.995, static_cast<int>(n)));
}

// Two fields of a real log, each against its two-sided 99 % interval; seed 1 is the program's default.
TEST_F(Convert, AddsNoiseOfTheSizeAskedForAndTheSameForTheSameSeed) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  const auto noisy = [&](const char* name, const char* seed) {
    must({"convert", "--noise", "odometry_heading_rad=0.01,point_x_m=0.05", "--seed", seed, path_, file(name)});
    return text_of(file(name));
  };
  EXPECT_EQ(noisy("a.circles", "1"), noisy("b.circles", "1"));
  EXPECT_NE(noisy("a2.circles", "2"), text_of(file("a.circles")));

  const core::Recording before = logs::read_dlr(path_);
  const core::Recording after = logs::read_dlr(file("a.circles"));
  EXPECT_EQ(after.labels, before.labels);
  expect_noise(before, after, 0.01, [](const core::Event& event, std::vector<double>& out) {
    if (const auto* o = std::get_if<core::Odometry>(&event)) out.push_back(o->T_before_after.heading_rad);
  });
  expect_noise(before, after, 0.05, [](const core::Event& event, std::vector<double>& out) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) return;
    for (const core::Observation& observation : scan->observations) out.push_back(observation.z[0]);
  });
}

TEST_F(Convert, PrintsTheMeasuredStandardDeviation) {
  const Outcome outcome = run({"convert", small_log(), file("a.g2o"), "--noise", "point_y_m=0.1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("noise on point_y_m: sigma 0.1, measured 0."), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("31 numbers (99 % interval 0."), std::string::npos) << outcome.out;
}

TEST_F(Convert, NamesTheNearestOfWhatIsMisspelt) {
  const fs::path log = small_log();
  refused({"convert", log, file("a.g2o"), "--noise", "pont_x_m=0.1"}, 2, "did you mean 'point_x_m'");
  refused({"convert", log, file("a.g2o"), "--noise", "point_x_m"}, 2, "expected FIELD=SIGMA");
  refused({"convert", log, file("a.g2o"), "--noise", "point_x_m=-1"}, 2, "expected a number");
  refused({"convert", log, file("a.g2o"), "--noise", "point_x_m=nan"}, 2, "expected a number");
  refused({"convert", log, file("a.g2o"), "--to", "g20"}, 2, "did you mean 'g2o'");
  refused({"convert", log, file("a.txt")}, 2, "--to");
  refused({"convert", log}, 2, "OUT");
  refused({"convrt", log, file("a.g2o")}, 2, "did you mean 'convert'");
  EXPECT_EQ(names(), std::set<std::string>{"log.txt"}) << "nothing is written";
}

TEST_F(Convert, RefusesWhatTheFormatOrTheLogCannotGive) {
  const fs::path log = small_log();
  refused({"convert", log, file("a.g2o"), "--noise", "range_m=0.1"}, 3, "no such numbers");
  refused({"convert", log, file("a.circles")}, 3, "a scan without motion before it");
  refused({"convert", file("nowhere"), file("a.g2o")}, 3, "nowhere");
  std::ofstream(file("spoilt.txt")) << circle_graph(3) << "LANDMRK 4 1 0 20 5 0 5\n";
  refused({"convert", file("spoilt.txt"), file("a.g2o")}, 3, "spoilt.txt:8");
  EXPECT_EQ(names(), (std::set<std::string>{"log.txt", "spoilt.txt"})) << "nothing half-written";
}

TEST_F(Convert, ReplacesAFileOnlyWhenAsked) {
  const fs::path log = small_log();
  std::ofstream(file("a.g2o")) << "precious\n";
  refused({"convert", log, file("a.g2o")}, 3, "--overwrite");
  EXPECT_EQ(text_of(file("a.g2o")), "precious\n");
  must({"convert", log, file("a.g2o"), "--overwrite"});
  EXPECT_NE(text_of(file("a.g2o")), "precious\n");
  fs::create_directory(file("folder.g2o"));
  refused({"convert", log, file("folder.g2o"), "--overwrite"}, 3, "found a folder");
}

TEST_F(Convert, KeepsTheVehicleThatTheLogIsReadBy) {
  must({"convert", small_log(), file("a.jsonl")});
  std::ofstream(file("vehicle.toml"), std::ios::app) << "# mine\n";
  must({"convert", file("a.jsonl"), file("b.jsonl"), "--overwrite"});
  EXPECT_NE(text_of(file("vehicle.toml")).find("# mine"), std::string::npos);
  refused({"convert", small_log(), file("c.jsonl")}, 3, "vehicle.toml: the file is there already");
  must({"convert", small_log(), file("c.jsonl"), "--overwrite"});
  EXPECT_EQ(text_of(file("vehicle.toml")).find("# mine"), std::string::npos);
}

TEST_F(Convert, RefusesALogWithoutLabelsForAGraph) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  refused({"convert", path_, file("a.g2o")}, 3, "no labels");
  EXPECT_TRUE(names().empty());
}

}  // namespace
}  // namespace helixnav::apps
