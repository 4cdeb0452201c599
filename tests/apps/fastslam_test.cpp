// SPDX-License-Identifier: BSD-3-Clause
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "real_data.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

class FastSlamFilter : public testing::RealDataTest {
 protected:
  fs::path out(const std::string& name) const { return folder_.path() / name; }
  json summary(const std::string& name) const { return json::parse(text_of(out(name) / "summary.json")); }
  Outcome filter(const Words& begin, const std::string& name, const Words& options) const {
    Words words = begin;
    words.insert(words.end(), {"--filter", "fastslam", "--quiet", "--out", out(name)});
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  void must(const Words& begin, const std::string& name, const Words& options) const {
    const Outcome outcome = filter(begin, name, options);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  void simulate(const std::string& name, const Words& options) const {
    Words begin{"simulate", "circuit"};
    if (options.empty() || options.front() != "--fastslam.particles") {
      begin.insert(begin.end(), {"--fastslam.particles", "30"});
    }
    must(begin, name, options);
  }
  /// Expects exit code 2 with these words, and no folder.
  void refuse(const Words& begin, const Words& options, const Words& said) const {
    const Outcome outcome = filter(begin, "refused", options);
    EXPECT_EQ(outcome.exit_code, 2) << options.front() << ": " << outcome.err;
    for (const std::string& word : said) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out("refused")));
  }
  std::string circle(int steps) const { return folder_.write("circle.txt", circle_graph(steps)); }

  testing::TemporaryFolder folder_;
};

/// What must not depend on the number of threads: everything except the wall clock and the settings themselves.
std::string bytes_of(const fs::path& file) {
  std::string text = text_of(file);
  if (file.filename() == "health.csv") return std::regex_replace(text, std::regex(",[^,\n]*\n"), "\n");
  const std::size_t clock = text.find(file.filename() == "summary.json" ? "\"timing\": {" : "id=\"wall-clock\"");
  if (clock != std::string::npos)
    text.erase(clock, text.find(file.filename() == "summary.json" ? "}" : "</script>", clock) - clock);
  return std::regex_replace(text, std::regex("threads( = |\\s)[0-9]+"), "threads");
}

TEST_F(FastSlamFilter, GivesTheSameBytesForAnyNumberOfThreadsAndOthersForAnotherSeed) {
  simulate("one", {"--fastslam.threads", "1"});
  simulate("two", {"--fastslam.threads", "2"});
  EXPECT_EQ(names_in(out("one")), names_in(out("two")));
  for (const std::string& name : names_in(out("one"))) {
    EXPECT_TRUE(bytes_of(out("one") / name) == bytes_of(out("two") / name)) << name << " differs";
  }
  simulate("seed", {"--fastslam.seed", "2"});
  EXPECT_NE(text_of(out("one") / "trajectory.tum"), text_of(out("seed") / "trajectory.tum"));
}

/// Noise of a micrometre for data good to 0.1 m leaves no particle with any weight, and covariances that are pure rounding.
/// The input is at fault: NIS reports this, and the drive goes on.
TEST_F(FastSlamFilter, GoesOnWhereNoParticleExplainsTheScan) {
  ASSERT_EQ(run({"new-vehicle", out("robot")}).exit_code, 0);
  const std::string vehicle = folder_.write("tight.toml",
                                            "[odometry]\nsigma_along_m_per_sqrt_m = 0.027\n"
                                            "sigma_sideways_m_per_sqrt_m = 0.005\nsigma_heading_deg_per_sqrt_m = 0.16\n"
                                            "[[sensor]]\nx_m = 0.5\nreach_m = 30.0\nmin_range_m = 1.0\n"
                                            "view_deg = [-90, 90]\nsigma_range_m = 1e-6\nsigma_bearing_rad = 1e-7\n");
  for (const char* seed : {"1", "2"}) {
    const Outcome outcome = filter({"replay", out("robot"), "--vehicle", vehicle}, seed,
                                   {"--fastslam.seed", seed, "--fastslam.version", "2"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("times larger than the assumed noise predicts"), std::string::npos) << outcome.err;
    for (const char* file : {"trajectory.tum", "map.csv"}) {
      EXPECT_EQ(text_of(out(seed) / file).find("nan"), std::string::npos) << file;
      EXPECT_EQ(text_of(out(seed) / file).find("inf"), std::string::npos) << file;
    }
  }
}

TEST_F(FastSlamFilter, WritesTheRunFolderOfANavigatorAndWhatParticlesAddToIt) {
  simulate("run", {});
  for (const char* name : {"manifest.json", "trajectory.tum", "map.csv", "associations.csv", "health.csv",
                           "summary.json", "report.html", "particles.csv", "paths.csv", "mixture.csv"}) {
    EXPECT_TRUE(fs::exists(out("run") / name)) << name;
  }
  const json found = summary("run");
  EXPECT_LT(found.at("error").at("rmse_m"), 1.0);
  EXPECT_GT(found.at("landmarks").at("mature"), 10);
  const auto scans = found.at("steps").get<std::size_t>();
  EXPECT_EQ(found.at("particles").at("scans"), scans);
  EXPECT_EQ(complete_lines(out("run") / "particles.csv"), scans + 1);
  const Outcome evaluation = run({"evaluate", out("run"), "--json"});
  EXPECT_EQ(json::parse(evaluation.out).at("particles"), found.at("particles"));
  const std::string config = json::parse(text_of(out("run") / "manifest.json")).at("config");
  EXPECT_NE(config.find("[filter]\n# Filter that navigates"), std::string::npos);
  EXPECT_NE(config.find("\nparticles = 30\n"), std::string::npos);
  EXPECT_EQ(config.find("Lengths in force"), std::string::npos);
  const Outcome explained = run({"explain", out("run")});
  EXPECT_NE(explained.out.find("no closings to explain"), std::string::npos) << explained.out;
  EXPECT_EQ(run({"explain", out("run"), "--step", "50"}).out.find("nan"), std::string::npos);
}

TEST_F(FastSlamFilter, EachSettingReachesTheParticles) {
  simulate("plain", {});
  const std::string plain = text_of(out("plain") / "trajectory.tum");
  for (const Words& options : {Words{"--fastslam.particles", "31"},
                               {"--fastslam.version", "1"},
                               {"--fastslam.association", "known"},
                               {"--fastslam.association", "nearest-neighbour"},
                               {"--fastslam.association", "sampled"},
                               {"--fastslam.association", "multiple-hypotheses"},
                               {"--fastslam.match_gate", "3"},
                               {"--fastslam.new_gate", "60"},
                               {"--fastslam.detection_probability", "0.6"},
                               {"--fastslam.weigh_unseen", "false"},
                               {"--fastslam.new_density", "1"},
                               {"--fastslam.clutter_density", "1"},
                               {"--fastslam.resample_below", "0.9"},
                               {"--fastslam.added_sigma_m", "0.02"},
                               {"--fastslam.added_sigma_rad", "0.01"}}) {
    simulate("run", options);
    EXPECT_NE(text_of(out("run") / "trajectory.tum"), plain) << options.front() << ' ' << options.back();
    fs::remove_all(out("run"));
  }
  simulate("genealogy", {"--fastslam.genealogy_m", "5"});
  EXPECT_EQ(text_of(out("genealogy") / "trajectory.tum"), plain);
  EXPECT_NE(text_of(out("genealogy") / "particles.csv"), text_of(out("plain") / "particles.csv"));
}

TEST_F(FastSlamFilter, KnowsLandmarksByTheirLabels) {
  must({"replay", circle(60)}, "known", {"--fastslam.association", "known"});
  const json found = summary("known");
  EXPECT_EQ(found.at("landmarks").at("mature"), 1);
  EXPECT_EQ(found.at("observations").at("augmented"), 1);
  EXPECT_EQ(found.at("observations").at("matched"), 60);
  must({"replay", circle(60)}, "unknown", {});
  EXPECT_EQ(summary("unknown").at("landmarks").at("mature"), 1);
}

TEST_F(FastSlamFilter, GoesThroughABlackoutByOdometry) {
  must({"replay", circle(60)}, "blind", {"--blackout", "10:20", "--fastslam.association", "known"});
  const json found = summary("blind");
  EXPECT_EQ(found.at("steps"), 61);
  const auto withheld = found.at("blackout").at("scans").get<int>();
  EXPECT_GT(withheld, 0);
  EXPECT_EQ(found.at("particles").at("scans"), 61 - withheld);
  EXPECT_EQ(found.at("observations").at("matched"), 60 - withheld);
}

TEST_F(FastSlamFilter, RefusesLogsThatItCannotMap) {
  folder_.write("log/odometry.csv", "t,v,omega\n0,2,0\n1,2,0\n2,2,0\n");
  folder_.write("log/detections.csv", "t,range_m,id\n1,10,a\n2,10,a\n");
  folder_.write("log/vehicle.toml",
                "[odometry]\nsigma_along_m_per_sqrt_m = 0.05\nsigma_sideways_m_per_sqrt_m = 0.02\n"
                "sigma_heading_deg_per_sqrt_m = 0.3\n"
                "[[sensor]]\nreach_m = 30\nsigma_range_m = 0.1\nsigma_bearing_deg = 0.5\n");
  const auto refused = [&](const Words& options, const std::string& word) {
    const Outcome outcome = filter({"replay", out("log")}, "refused", options);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out("refused")));
  };
  refused({"--fastslam.association", "known"}, "a detection of a range alone");
  folder_.write("log/detections.csv", "t,range_m,bearing_deg\n1,10,5\n2,9,5\n");
  refused({"--fastslam.association", "known"}, "--fastslam.association known needs a labelled log");
}

TEST_F(FastSlamFilter, TakesTheDetectionProbabilityOfTheVehicle) {
  folder_.write("log/odometry.csv", "t,v,omega\n0,2,0\n1,2,0\n2,2,0\n");
  folder_.write("log/detections.csv", "t,range_m,bearing_deg\n1,10,5\n2,8,6\n");
  folder_.write("log/vehicle.toml",
                "[odometry]\nsigma_along_m_per_sqrt_m = 0.05\nsigma_sideways_m_per_sqrt_m = 0.02\n"
                "sigma_heading_deg_per_sqrt_m = 0.3\n"
                "[[sensor]]\nreach_m = 30\nsigma_range_m = 0.1\nsigma_bearing_deg = 0.5\n"
                "detection_probability = 0.625\n");
  const auto checked = [&](const Words& options) {
    Words words{"check", out("log"), "--filter", "fastslam"};
    words.insert(words.end(), options.begin(), options.end());
    return run(words).out;
  };
  const std::string said =
      "settings    FastSLAM 2.0, 200 particles, association likelihood-ratio, detection probability ";
  EXPECT_NE(checked({}).find(said + "0.625\n"), std::string::npos) << checked({});
  EXPECT_NE(checked({"--fastslam.detection_probability", "0.75"}).find(said + "0.75\n"), std::string::npos);
  must({"replay", out("log")}, "run", {});
  const std::string config = json::parse(text_of(out("run") / "manifest.json")).at("config");
  EXPECT_NE(config.find("\ndetection_probability = 0.625\n"), std::string::npos);
}

TEST_F(FastSlamFilter, RefusesWhatHasNoPartInIt) {
  const Words replay{"replay", circle(10)};
  refuse(replay, {"--smooth"}, {"--smooth", "fastslam"});
  refuse(replay, {"--localize", "--map", "somewhere"}, {"--map", "map of its own"});
  refuse(replay, {"--map", "somewhere", "--start", "end"}, {"--map", "map of its own"});
  refuse({"simulate", "circuit"}, {"--map", "somewhere"}, {"--map", "map of its own"});
  refuse(replay, {"--gps", "fuse"}, {"--gps.use", "does not use GPS"});
  refuse(replay, {"--association", "known"}, {"--association.method", "--fastslam.association"});
  const std::string defaults = folder_.write("defaults.toml", run({"config", "--dump"}).out);
  refuse(replay, {"--search.threads", "2", "--config", defaults}, {"--search.threads", "no part in --filter fastslam"});
  refuse(replay, {"--filter.cell_side_m", "20"}, {"--filter.cell_side_m", "no part"});
  refuse(replay, {"--slip.enabled", "true"}, {"--slip.enabled", "no part"});
  refuse(replay, {"--landmarks.mature_looks", "4"}, {"--landmarks.mature_looks", "--fastslam.mature_looks"});
  refuse(replay, {"--fastslam.new_gate", "5"}, {"--fastslam.new_gate", "match_gate"});
  refuse(replay, {"--fastslam.split_always", "true"}, {"--fastslam.split_always", "multiple-hypotheses"});
  refuse(replay, {"--fastslam.association", "multiple-hypotheses", "--fastslam.resample_below", "0.2"},
         {"--fastslam.resample_below", "resample_every_scans"});
  refuse({"simulate", "circuit"}, {"--search.seed", "7"}, {"--search.seed", "no part"});
  refuse({"montecarlo", "circuit"}, {"--runs", "1"}, {"--filter fastslam", "simulate takes it"});
  for (const Words& begin : {Words{"associate", "circuit"}, {"calibrate", "log"}, {"stream", "--vehicle", "none"}}) {
    Words words = begin;
    words.insert(words.end(), {"--filter", "fastslam"});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << begin.front() << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("--filter fastslam"), std::string::npos) << outcome.err;
  }
}

TEST_F(FastSlamFilter, HasSettingsThatAreRefusedWithoutIt) {
  for (const Words& begin : {Words{"simulate", "circuit"}, {"replay", "log"}, {"montecarlo", "circuit"}}) {
    Words words = begin;
    words.insert(words.end(), {"--fastslam.particles", "50", "--out", out("none")});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("is of --filter fastslam"), std::string::npos) << outcome.err;
  }
}

TEST_F(FastSlamFilter, TakesTheDumpOfTheDefaultsAndOfItself) {
  const std::string defaults = folder_.write("defaults.toml", run({"config", "--dump"}).out);
  const std::string own =
      folder_.write("own.toml", run({"config", "--dump", "--filter", "fastslam", "--fastslam.particles", "30"}).out);
  simulate("plain", {});
  simulate("defaults", {"--config", defaults});
  const Outcome outcome = run({"simulate", "circuit", "--config", own, "--out", out("own")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"defaults", "own"}) {
    EXPECT_EQ(text_of(out("plain") / "trajectory.tum"), text_of(out(name) / "trajectory.tum")) << name;
  }
}

TEST_F(FastSlamFilter, RefusesValuesOutOfRange) {
  for (const Words& options : {Words{"--filter", "fastslan"},
                               {"--fastslam.particles", "0"},
                               {"--fastslam.version", "3"},
                               {"--fastslam.association", "nearest"},
                               {"--fastslam.threads", "0"},
                               {"--fastslam.seed", "-1"},
                               {"--fastslam.detection_probability", "1"},
                               {"--fastslam.match_gate", "nan"},
                               {"--fastslam.resample_below", "1.5"},
                               {"--fastslam.weigh_unseen", "yes"},
                               {"--fastslam.look_probability", "0.1"},
                               {"--fastslam.genealogy_m", "0"}}) {
    Words words{"config", "--dump"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << options.front();
    EXPECT_NE(outcome.err.find('\'' + options.back() + '\''), std::string::npos) << outcome.err;
  }
}

TEST_F(FastSlamFilter, FindsTheBeaconsOfTheCarPark) {
  find_real_data("carpark/raw/data_set.mat");
  if (IsSkipped()) return;
  must({"replay", path_}, "car-park", {"--fastslam.detection_probability", "0.5"});
  const json found = summary("car-park");
  EXPECT_LT(found.at("error").at("rmse_m"), 0.27);
  EXPECT_EQ(found.at("landmark_error").at("missing"), 0);
}

}  // namespace
}  // namespace helixnav::apps
