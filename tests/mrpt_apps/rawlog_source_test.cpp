// SPDX-License-Identifier: BSD-3-Clause
#include "slam/rawlog_source.hpp"

#include <string>

#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "input_error.hpp"
#include "program.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

/// Rawlogs in letters: M movement, m single action, F frame, O observation.
class Source : public ::testing::Test {
 protected:
  std::string rawlog(const std::string& entries) const {
    const std::string path = folder_.path() / (entries + ".rawlog");
    RawlogSink sink(path);
    for (const char entry : entries) {
      mrpt::obs::CObservationComment comment;
      if (entry == 'M') sink.write(mrpt::obs::CActionCollection());
      if (entry == 'm') sink.write(mrpt::obs::CActionRobotMovement2D());
      if (entry == 'F') sink.write(mrpt::obs::CSensoryFrame());
      if (entry == 'O') sink.write(comment);
    }
    sink.finish();
    return path;
  }

  /// The turns of a rawlog of these entries, with the number of the last entry of each.
  std::string turns(const std::string& entries, std::size_t offset = 0) const {
    RawlogSource source(rawlog(entries), offset, {});
    std::string text;
    while (const auto turn = source.next()) {
      text += text.empty() ? "" : " ";
      if (turn->movement) text += 'M';
      if (turn->frame) text += 'F';
      if (turn->observation) text += 'O';
      text += std::to_string(source.last_entry());
    }
    EXPECT_FALSE(source.next());
    EXPECT_EQ(source.damage(), "");
    return text;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Source, HandsOutFramesAndObservationsWithTheMovementBeforeThem) {
  EXPECT_EQ(turns("MFMF"), "MF1 MF3");
  EXPECT_EQ(turns("OOMO"), "O0 O1 MO3");
  EXPECT_EQ(turns("mF"), "MF1");
}

TEST_F(Source, LosesNoFrameWithoutMovementAndNoMovementWithoutFrame) {
  EXPECT_EQ(turns("FMFF"), "F0 MF2 F3");
  EXPECT_EQ(turns("MMF"), "M0 MF2");
  EXPECT_EQ(turns("FM"), "F0");  // nothing was seen from there
}

TEST_F(Source, BeginsBehindTheOffset) {
  EXPECT_EQ(turns("MFMF", 2), "MF3");
  EXPECT_EQ(turns("MFMF", 3), "F3");
  EXPECT_EQ(turns("MFMF", 4), "");
  EXPECT_EQ(turns("MFMF", 100), "");
}

TEST_F(Source, SaysWhatIsWrongWithTheFileAndHandsOutWhatStandsBefore) {
  const std::string whole = text_of(rawlog("MFMFMF"));
  RawlogSource source(folder_.write("cut.rawlog", whole.substr(0, whole.size() - 6)), 0, {});
  while (source.next()) {
  }
  EXPECT_EQ(source.last_entry(), 5U);
  EXPECT_NE(source.damage().find("cut.rawlog: entry 6 is missing: the file was cut off"), std::string::npos)
      << source.damage();
  const std::string none =
      testing::input_error_of([&] { RawlogSource missing(folder_.path() / "none.rawlog", 0, {}); });
  EXPECT_NE(none.find("found nothing there"), std::string::npos) << none;
}

}  // namespace
}  // namespace helixnav::apps
