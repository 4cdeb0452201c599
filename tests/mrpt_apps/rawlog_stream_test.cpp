// SPDX-License-Identifier: BSD-3-Clause
#include "reading/rawlog_stream.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>

#include "input_error.hpp"
#include "rawlog/write_recording.hpp"
#include "small_rawlogs.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

using testing::input_error_of;

std::string bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string uncompressed(const std::string& file) {
  mrpt::io::CFileGZInputStream gz(file);
  std::string content(1 << 20, '\0');
  content.resize(gz.Read(content.data(), content.size()));
  return content;
}

struct Read {
  std::size_t entries = 0;
  std::string damage;
};

Read read_all(const std::string& path) {
  RawlogStream stream(path);
  while (stream.next()) {
  }
  return {stream.entries(), stream.damage()};
}

/// 21 movements and 21 frames.
class RawlogFile : public ::testing::Test {
 protected:
  RawlogFile() : path_(folder_.path() / "posts.rawlog") {
    write_recording(testing::past_posts(), path_, LandmarkIds::labels);
  }

  std::string with(const std::string& name, const std::string& content) const { return folder_.write(name, content); }

  testing::TemporaryFolder folder_;
  std::string path_;
};

TEST_F(RawlogFile, ReadsTheSameCompressedAndNot) {
  EXPECT_EQ(bytes_of(path_).substr(0, 2), "\x1f\x8b");
  const Read plain = read_all(with("plain.rawlog", uncompressed(path_)));
  EXPECT_EQ(plain.entries, 42U);
  EXPECT_EQ(plain.damage, "");
  EXPECT_EQ(read_all(path_).entries, 42U);
  EXPECT_EQ(read_all(path_).damage, "");
}

TEST_F(RawlogFile, HandsOutWhatStandsBeforeTheEndOfATruncatedFile) {
  const std::string packed = bytes_of(path_);
  const Read cut = read_all(with("cut.rawlog", packed.substr(0, packed.size() * 2 / 3)));
  EXPECT_GT(cut.entries, 10U);
  EXPECT_LT(cut.entries, 42U);
  EXPECT_NE(cut.damage.find("cut.rawlog: entry " + std::to_string(cut.entries)), std::string::npos) << cut.damage;

  // All entries are there, and still the file reports that it was longer.
  const Read tail = read_all(with("tail.rawlog", packed.substr(0, packed.size() - 6)));
  EXPECT_EQ(tail.entries, 42U);
  EXPECT_NE(tail.damage.find("cut off"), std::string::npos) << tail.damage;

  const std::string plain = uncompressed(path_);
  const Read plain_cut = read_all(with("plain.rawlog", plain.substr(0, plain.size() - 20)));
  EXPECT_EQ(plain_cut.entries, 41U);
  EXPECT_NE(plain_cut.damage.find("entry 41"), std::string::npos) << plain_cut.damage;
}

TEST_F(RawlogFile, NamesAnUnknownClassAndTheEntryThatHasIt) {
  std::string plain = uncompressed(path_);
  const std::string known = "CSensoryFrame";
  plain.replace(plain.rfind(known), known.size(), "CSensoryFrom!");
  const Read read = read_all(with("unknown.rawlog", plain));
  EXPECT_EQ(read.entries, 41U);
  EXPECT_NE(read.damage.find("entry 41"), std::string::npos) << read.damage;
  EXPECT_NE(read.damage.find("CSensoryFrom!"), std::string::npos) << read.damage;
}

TEST_F(RawlogFile, RefusesWhatIsNoRawlog) {
  const auto refusal = [](const std::string& path) { return input_error_of([&] { RawlogStream stream(path); }); };
  EXPECT_NE(refusal(folder_.path() / "none.rawlog").find("found nothing there"), std::string::npos);
  EXPECT_NE(refusal(folder_.path()).find("found a folder"), std::string::npos);
  EXPECT_NE(refusal(with("empty.rawlog", "")).find("empty file"), std::string::npos);
  EXPECT_NE(refusal(with("text.rawlog", "STEP a.jpg 1 2 3\n")).find("text.rawlog: entry 0"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::apps
