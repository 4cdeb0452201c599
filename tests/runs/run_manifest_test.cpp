// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_manifest.hpp"

#include <gtest/gtest.h>

#include "helixnav/files/number_text.hpp"
#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

using helixnav::testing::input_error_of;
using helixnav::testing::TemporaryFolder;

TEST(Sha256, EqualsThePublishedDigests) {
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.write("empty", "").string()),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc").string()),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.write("million", std::string(1'000'000, 'a')).string()),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, NamesAFileThatCannotBeRead) {
  EXPECT_NE(input_error_of([] { sha256_of_file("no/such/file"); }).find("no/such/file"), std::string::npos);
}

TEST(CommandText, LeavesOutWhereTheRunIsKeptAndQuotesForTheShell) {
  EXPECT_EQ(
      command_text({"/usr/bin/helixnav", "replay", "a log's", "--out", "x", "--seed=7", "--out=y", "--overwrite"}),
      "helixnav replay 'a log'\\''s' --seed=7");
}

TEST(Numbers, RoundTripInTheFewestDigits) {
  std::string text;
  files::append_number(text, 0.1);
  text += ' ';
  files::append_number(text, 1.0 / 3.0);
  text += ' ';
  files::append_number(text, -0.0 / 1.0 * std::numeric_limits<double>::infinity());
  EXPECT_EQ(text, "0.1 0.3333333333333333 nan");
  EXPECT_EQ(*files::parse_number("0.3333333333333333"), 1.0 / 3.0);
  EXPECT_FALSE(files::parse_number("1.0x"));
  EXPECT_FALSE(files::parse_number(""));
}

TEST(Seconds, AreExactToTheNanosecond) {
  for (const std::int64_t t_ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1'000'000'001},
                                  std::int64_t{1'065'000'000'214'000'007}, std::int64_t{-250'000'000}}) {
    std::string text;
    files::append_seconds(text, t_ns);
    EXPECT_EQ(files::parse_seconds(text), t_ns) << text;
  }
  EXPECT_EQ(files::parse_seconds("1.5e1"), 15'000'000'000);
  EXPECT_FALSE(files::parse_seconds("nan"));
  EXPECT_FALSE(files::parse_seconds("-"));
}

}  // namespace
}  // namespace helixnav::runs
