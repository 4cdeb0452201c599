// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/read_recording.hpp"

#include <string>
#include <utility>
#include <vector>

#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

class RecogniseRealLogs : public testing::RealDataTest {};

TEST_F(RecogniseRealLogs, NamesEachFormat) {
  const std::vector<std::pair<std::string, LogFormat>> logs = {
      {"victoria_park/raw/victoria_park_ascii.zip", LogFormat::acfr_ascii},
      {"victoria_park/raw", LogFormat::victoria_park_mat},
      {"carpark/raw", LogFormat::car_park_mat},
      {"carpark/raw/data_set.mat", LogFormat::car_park_mat},
      {"victoria_park_graph/raw/isam_victoriaPark.txt", LogFormat::pose_landmark_text},
      {"victoria_park_graph/raw/gtsam_victoria_park.txt", LogFormat::pose_landmark_text},
      {"victoria_park_graph/raw/VicPark_clean_data.mat", LogFormat::slsjf_mat},
      {"dlr/raw/map.circles", LogFormat::dlr},
      {"dlr/raw/dlr.g2o", LogFormat::g2o},
      {"plaza", LogFormat::plaza},
      {"plaza/plaza1_odometry.csv", LogFormat::plaza},
  };
  for (const auto& [path, format] : logs) {
    ASSERT_NO_FATAL_FAILURE(find_real_data(path));
    if (IsSkipped()) {
      return;
    }
    EXPECT_EQ(name_of(recognise(path_)), name_of(format)) << path;
  }
}

TEST_F(RecogniseRealLogs, ReadsWhatItRecognises) {
  for (const char* path : {"carpark/raw", "plaza", "victoria_park_graph/raw/isam_victoriaPark.txt"}) {
    find_real_data(path);
    if (IsSkipped()) {
      return;
    }
    const core::Recording recording = read_recording(path_);
    EXPECT_FALSE(recording.events.empty()) << path;
    EXPECT_FALSE(recording.name.empty()) << path;
  }
}

TEST(Recognise, ReadsAFileByItsContentWhateverItIsCalled) {
  const TemporaryFolder folder;
  EXPECT_EQ(recognise(folder.write("a.zip", "# graph\nLANDMARK 0 1 1 1 1 0 1\n")), LogFormat::pose_landmark_text);
  EXPECT_EQ(recognise(folder.write("b", "VERTEX_SE2 0 0 0 0\n")), LogFormat::g2o);
}

TEST(Recognise, SaysWhatWasLookedForWhereNothingIsKnown) {
  const TemporaryFolder folder;
  for (const std::string& content : {std::string(), std::string("hello"), std::string(3000, '\x81'),
                                     std::string("PK\x03\x04 broken"), std::string("MATLAB 5.0 MAT-file, no more")}) {
    const auto path = folder.write("thing", content);
    const std::string message = input_error_of([&] { recognise(path); });
    EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
  }
  EXPECT_NE(input_error_of([&] { recognise(folder.path()); }).find("Looked for"), std::string::npos);
  EXPECT_NE(input_error_of([&] { recognise(folder.path() / "none"); }).find("found nothing there"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
