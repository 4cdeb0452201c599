// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Usage : public ::testing::Test {
 protected:
  /// Runs with --out and expects exit 2, these words on stderr, and no run folder.
  void expect_misused(Words arguments, const Words& said) const {
    const fs::path out = folder_.path() / "run";
    arguments.insert(arguments.end(), {"--out", out});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    for (const std::string& word : said) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "no \"" << word << "\" in: " << outcome.err;
    }
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(fs::exists(out));
  }
  /// The same for a configuration file of this text.
  void expect_misconfigured(const std::string& text, Words said) const {
    const fs::path file = folder_.write("mine.toml", text);
    said.push_back("mine.toml");
    expect_misused({"simulate", "--config", file}, said);
    const Outcome check = run({"config", "--check", file});
    EXPECT_EQ(check.exit_code, 2) << check.err;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Usage, OfTheBareProgramIsShownAndIsAFailure) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  for (const char* word : {"Usage: helixnav", "replay", "simulate", "evaluate", "config"}) {
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
}

TEST_F(Usage, HelpAndVersionSucceedOnEveryCommand) {
  for (const Words& command : {Words{}, {"replay"}, {"simulate"}, {"evaluate"}, {"associate"}, {"config"}}) {
    for (const std::string option : {"--help", "--version"}) {
      Words words = command;
      words.push_back(option);
      const Outcome outcome = run(words);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_NE(outcome.out.find(option == "--help" ? "Usage: " : "helixnav 0."), std::string::npos) << outcome.out;
      EXPECT_EQ(outcome.err, "");
    }
  }
}

TEST_F(Usage, HelpOfACommandThatRunsShowsAnExample) {
  for (const std::string command : {"replay", "simulate", "evaluate", "associate", "config"}) {
    const std::string help = run({command, "--help"}).out;
    EXPECT_NE(help.find("\n  helixnav " + command), std::string::npos) << help;
  }
}

TEST_F(Usage, OfUnknownNamesProposesTheNearest) {
  expect_misused({"simulat"}, {"unknown command 'simulat'", "did you mean 'simulate'"});
  expect_misused({"simulate", "--sead", "3"}, {"unknown option '--sead'", "did you mean '--seed'"});
  expect_misused({"simulate", "--filter.cell_side=5"}, {"'--filter.cell_side'", "did you mean '--filter.cell_side_m'"});
  expect_misused({"simulate", "large-lop"}, {"unknown name 'large-lop'", "did you mean 'large-loop'"});
  expect_misused({"simulate", "--association", "jbcc"}, {"unknown name 'jbcc'", "did you mean 'jcbb'"});
  expect_misused({"simulate", "-x"}, {"unknown option '-x'"});
  expect_misused({"simulate", "large-loop", "extra"}, {"unexpected argument 'extra'"});
}

TEST_F(Usage, OfAnOptionBeforeItsCommandSaysWhereItBelongs) {
  const Outcome outcome = run({"--out", folder_.path() / "run", "simulate"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("option '--out' belongs after the command"), std::string::npos) << outcome.err;
}

TEST_F(Usage, OfAValueOutOfItsRangeNamesTheRange) {
  expect_misused({"simulate", "--filter.cell_side_m", "-5"}, {"--filter.cell_side_m", "from 0.001 to 1000000", "'-5'"});
  expect_misused({"simulate", "--filter.cell_side_m", "nan"}, {"--filter.cell_side_m", "a number from 0.001", "'nan'"});
  expect_misused({"simulate", "--landmarks.mature_looks", "2.5"},
                 {"--landmarks.mature_looks", "a whole number", "'2.5'"});
  expect_misused({"simulate", "--seed", "-1"}, {"--seed", "a whole number from 0", "'-1'"});
  expect_misused({"simulate", "--seed", "abc"}, {"--seed", "a whole number from 0", "'abc'"});
}

TEST_F(Usage, OfAMissingArgumentNamesIt) {
  expect_misused({"replay"}, {"PATH is required", "helixnav replay --help"});
  const Outcome outcome = run({"simulate"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--out is required"), std::string::npos) << outcome.err;
}

TEST_F(Usage, OfAConfigurationNamesFileAndLine) {
  expect_misconfigured("[filter]\n# a comment\ncell_sid_m = 30\n",
                       {"mine.toml:3", "unknown key 'filter.cell_sid_m'", "'filter.cell_side_m'"});
  expect_misconfigured("[filter]\ncell_side_m = -0.5\n", {"mine.toml:2", "from 0.001 to 1000000", "'-0.5'"});
  expect_misconfigured("[filter]\ncell_side_m = nan\n", {"mine.toml:2", "'nan'"});
  expect_misconfigured("filter.cell_side_m = -0.5\n", {"mine.toml:1:", "'-0.5'"});
  expect_misconfigured("[filter]\nfoo = 30\n",
                       {"mine.toml:2", "unknown key 'filter.foo'; 'helixnav config --dump' lists all"});
  expect_misconfigured("[filters]\ncell_side_m = 30\n", {"mine.toml:2", "'filter.cell_side_m'"});
  expect_misconfigured("[association]\nmethod = \"jbcc\"\n", {"mine.toml:2", "did you mean 'jcbb'"});
}

TEST_F(Usage, OfAConfigurationThatIsNotThereNamesIt) {
  expect_misused({"simulate", "--config", folder_.path() / "none.toml"}, {"none.toml", "cannot read"});
  expect_misused({"simulate", "--config", folder_.path()}, {"cannot read"});
}

}  // namespace
}  // namespace helixnav::apps
