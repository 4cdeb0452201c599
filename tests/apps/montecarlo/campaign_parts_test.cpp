// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/files/file.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

using OrderedJson = nlohmann::ordered_json;

class CampaignParts : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome drive(const std::string& name, const std::string& seeds, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"montecarlo", "circuit", "--quiet", "--jobs", "1",
                                   "--seeds",    seeds,     "--out",   out(name)};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  Outcome merge(const std::vector<std::string>& parts, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"montecarlo", "--merge"};
    for (const std::string& part : parts) words.push_back(out(part));
    words.insert(words.end(), {"--out", out("merged")});
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  void expect_refused(const Outcome& outcome, const std::string& why, int code = 3) const {
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out("merged")));
  }

  /// Everything except the wall clock.
  std::string lines(const std::string& name) const {
    std::ifstream file(out(name) + "/runs.jsonl");
    std::string text;
    for (std::string line; std::getline(file, line);) {
      OrderedJson row = OrderedJson::parse(line);
      row.erase("wall");
      text += row.dump() + '\n';
    }
    return text;
  }
  std::string summary(const std::string& name) const {
    OrderedJson json = OrderedJson::parse(text_of(out(name) + "/summary.json"));
    EXPECT_EQ(json.erase("wall"), 1u);
    return json.dump(2);
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(CampaignParts, MergedInAnyOrderAreTheCampaignOfOneMachine) {
  ASSERT_EQ(drive("whole", "3:8").exit_code, 0);
  ASSERT_EQ(drive("a", "3:4").exit_code, 0);
  ASSERT_EQ(drive("b", "5:5").exit_code, 0);
  ASSERT_EQ(drive("b", "6:6").exit_code, 0);  // resumes a folder
  ASSERT_EQ(drive("c", "7:8").exit_code, 0);
  ASSERT_EQ(merge({"c", "a", "b"}).exit_code, 0);
  EXPECT_EQ(text_of(out("merged") + "/manifest.json"), text_of(out("whole") + "/manifest.json"));
  EXPECT_EQ(lines("merged"), lines("whole"));
  EXPECT_EQ(summary("merged"), summary("whole"));
  EXPECT_EQ(merge({"a"}).exit_code, 3) << "the folder is not empty";
  EXPECT_EQ(merge({"a"}, {"--overwrite"}).exit_code, 0);
}

TEST_F(CampaignParts, OfDifferentSettingsAreNotMerged) {
  ASSERT_EQ(drive("a", "1:1").exit_code, 0);
  ASSERT_EQ(drive("b", "2:2", {"--search.particles", "300"}).exit_code, 0);
  expect_refused(merge({"a", "b"}), "search.particles");
}

TEST_F(CampaignParts, ThatOverlapAreNotMerged) {
  ASSERT_EQ(drive("a", "1:2").exit_code, 0);
  ASSERT_EQ(drive("b", "2:3").exit_code, 0);
  expect_refused(merge({"a", "b"}), "seed 2 is in");
  expect_refused(merge({"a", "a"}), "seed 1 is in");
}

TEST_F(CampaignParts, BetweenWhichSeedsAreMissingAreNotMerged) {
  ASSERT_EQ(drive("a", "1:1").exit_code, 0);
  ASSERT_EQ(drive("b", "4:4").exit_code, 0);
  ASSERT_EQ(drive("c", "6:6").exit_code, 0);
  expect_refused(merge({"c", "a", "b"}), "seeds 2 to 3, 5 are in none of the parts");
  ASSERT_EQ(drive("b", "2:5").exit_code, 0);
  EXPECT_EQ(merge({"c", "a", "b"}).exit_code, 0);
}

TEST_F(CampaignParts, ThatWereNotDrivenToTheirEndAreNotMerged) {
  ASSERT_EQ(drive("a", "1:3").exit_code, 0);
  const std::string rows = text_of(out("a") + "/runs.jsonl");
  files::write_whole_file(out("a") + "/runs.jsonl", rows.substr(0, rows.find('\n') + 10));
  expect_refused(merge({"a"}), "2 of its seeds were not driven, the first is 2");
  ASSERT_EQ(drive("a", "1:3").exit_code, 0);
  EXPECT_EQ(merge({"a"}).exit_code, 0);
}

TEST_F(CampaignParts, ThatAreNoneAreSaid) {
  expect_refused(merge({"nowhere"}), "nowhere/manifest.json: cannot read");
  ASSERT_EQ(drive("a", "1:1").exit_code, 0);
  files::write_whole_file(out("a") + "/manifest.json", "{\"format\": \"other\"}");
  expect_refused(merge({"a"}), "not the manifest of a campaign");
}

TEST_F(CampaignParts, AreNotWrittenOver) {
  ASSERT_EQ(drive("a", "1:1").exit_code, 0);
  ASSERT_EQ(drive("b", "2:2").exit_code, 0);
  const std::string rows = text_of(out("a") + "/runs.jsonl");
  for (const std::string& into : {out("a"), out("b/../a/")}) {
    const Outcome outcome = run({"montecarlo", "--merge", out("a"), out("b"), "--out", into, "--overwrite"});
    expect_refused(outcome, "--out is one of the parts to merge");
  }
  EXPECT_EQ(text_of(out("a") + "/runs.jsonl"), rows);
}

TEST_F(CampaignParts, WhoseManifestHasAWrongValueAreRefusedByItsKey) {
  ASSERT_EQ(drive("a", "1:1").exit_code, 0);
  const std::string file = out("a") + "/manifest.json";
  const OrderedJson whole = OrderedJson::parse(text_of(file));
  for (const auto& [key, value, why] : {std::tuple<const char*, OrderedJson, const char*>{"scenario", 3, "a text"},
                                        {"config", "none", "a list of lines"},
                                        {"seeds", 5, "pairs of a first and a last seed"},
                                        {"seeds", {{4, 2}}, "pairs of a first and a last seed"}}) {
    OrderedJson wrong = whole;
    wrong[key] = value;
    files::write_whole_file(file, wrong.dump());
    expect_refused(merge({"a"}), file + ": \"" + key + "\" is " + value.dump() + ", expected " + why);
  }
}

TEST_F(CampaignParts, WordsThatDoNotGoTogetherAreRefused) {
  expect_refused(run({"montecarlo", "circuit", "--merge", out("a"), "--out", out("merged")}), "", 2);
  expect_refused(merge({"a"}, {"--seeds", "1:2"}), "has no part in --merge", 2);
  expect_refused(merge({"a"}, {"--search.particles", "300"}), "has no part in --merge", 2);
  expect_refused(run({"montecarlo", "--out", out("merged")}), "SCENARIO", 2);
  for (const char* seeds : {"5", "5:4", ":3", "1:", "a:b", "1:2:3", "-1:4", "1:99999999", "1:9999999999999999999999"}) {
    EXPECT_EQ(drive("a", seeds).exit_code, 2) << seeds;
  }
  EXPECT_EQ(drive("a", "1:2", {"--runs", "3"}).exit_code, 2);
}

TEST_F(CampaignParts, AFolderIsDrivenByOneProcessOnly) {
  Program first({"montecarlo", "circuit", "--runs", "1000000", "--jobs", "1", "--quiet", "--out", out("a")});
  while (!std::filesystem::exists(out("a") + "/runs.jsonl") || complete_lines(out("a") + "/runs.jsonl") < 1) {
  }
  const Outcome second = drive("a", "1:2");
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_NE(second.err.find("another process writes into this folder"), std::string::npos) << second.err;
}

}  // namespace
}  // namespace helixnav::apps
