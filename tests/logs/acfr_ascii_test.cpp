// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>

#include <archive.h>
#include <archive_entry.h>

#include "helixnav/logs/acfr_log.hpp"
#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

class VictoriaParkText : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("victoria_park/raw/victoria_park_ascii.zip"); }
};

TEST_F(VictoriaParkText, HasTheReadingsOfEachSensorInTheOrderOfTheManager) {
  const AcfrLog log = read_acfr_ascii(path_);
  EXPECT_EQ(log.dead_reckoning.size(), 61763u);
  EXPECT_EQ(log.scans.size(), 7230u);
  EXPECT_EQ(log.gps.size(), 948u);
  ASSERT_EQ(log.order.size(), 69941u);
  EXPECT_EQ(log.order[1].sensor, AcfrLog::Sensor::laser);
  EXPECT_EQ(log.order[2].sensor, AcfrLog::Sensor::dead_reckoning);
  EXPECT_EQ(log.scans[0].t_ns, 852'000'000);
  EXPECT_EQ(log.scans[0].range_cm[0], 83);
  EXPECT_EQ(log.scans[0].range_cm[102], 2029);
  EXPECT_EQ(log.dead_reckoning[0].steering_rad, -0.0011);
  EXPECT_EQ(log.gps.back().position_m, Eigen::Vector2d(-18.53, -11.32));
}

/// One scan of 361 ranges of 2.5 m.
std::string scan_text(const std::string& time) {
  std::string text = time;
  for (int beam = 0; beam < SickScan::beams; ++beam) {
    text += "\t2.50";
  }
  return text;
}

/// A small valid release; tests corrupt one file of it.
class SmallRelease : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("DRS.txt", "0.1\t 1.0\t0.05\r\n0.2\t 1.5\t0.06\r\n");
    folder_.write("LASER.txt", scan_text("0.15") + "\t" + scan_text("0.2"));
    folder_.write("GPS.txt", "0.0\t 3.0\t 4.0\r\n");
    folder_.write("Sensors_manager.txt", "0.0\t1\t1\r\n0.1\t2\t1\r\n0.15\t3\t1\r\n0.2\t3\t2\r\n0.2\t2\t2\r\n");
  }

  AcfrLog read() const { return read_acfr_ascii(folder_.path()); }
  std::string error_after_writing(const std::string& file, const std::string& text) const {
    folder_.write(file, text);
    const std::string message = input_error_of([&] { read(); });
    EXPECT_EQ(message.rfind(folder_.path().string(), 0), 0u) << message;
    return message.substr(std::min(message.size(), folder_.path().string().size() + 1));
  }

  TemporaryFolder folder_;
};

TEST_F(SmallRelease, IsReadFromAFolder) {
  const AcfrLog log = read();
  EXPECT_EQ(log.order.size(), 5u);
  EXPECT_EQ(log.scans[1].range_cm[360], 250);
  EXPECT_EQ(log.gps[0].position_m, Eigen::Vector2d(4.0, 3.0));
}

TEST_F(SmallRelease, NamesTheFileThatIsMissing) {
  std::filesystem::remove(folder_.path() / "GPS.txt");
  EXPECT_NE(input_error_of([&] { read(); }).find("GPS.txt: expected a file that can be read"), std::string::npos);
}

TEST_F(SmallRelease, NamesLineOrByteOfGarbage) {
  EXPECT_EQ(error_after_writing("DRS.txt", "0.1\t1\t0\n0.2\tNaN\t0\n"),
            "DRS.txt:2: expected a speed [m/s], found 'NaN'");
}

TEST_F(SmallRelease, RefusesASteeringThatNoTruckCanDo) {
  EXPECT_EQ(error_after_writing("DRS.txt", "0.1\t1\t57.0\n"),
            "DRS.txt:1: expected a steering angle [rad] (-1.2 … 1.2), found '57.0'");
}

TEST_F(SmallRelease, NamesTheByteInTheLaserFile) {
  const std::string first = scan_text("0.15");
  EXPECT_EQ(error_after_writing("LASER.txt", first + "\t0.2\t2.50\t2,5\t1.0"),
            "LASER.txt: byte " + std::to_string(first.size() + 10) +
                ": expected a range [m], one of 361 in a scan, found '2,5'");
}

TEST_F(SmallRelease, NamesTheByteWhereAScanIsCutOff) {
  const std::string text = scan_text("0.15") + "\t0.2\t2.50";
  EXPECT_EQ(error_after_writing("LASER.txt", text),
            "LASER.txt: byte " + std::to_string(text.size()) +
                ": expected a range [m], one of 361 in a scan, found the end of the file");
}

TEST_F(SmallRelease, RefusesARangeThatNoScannerGives) {
  EXPECT_EQ(error_after_writing("LASER.txt", "0.1\t-1.0"),
            "LASER.txt: byte 4: expected a range [m], one of 361 in a scan (0 … 655.35), found '-1.0'");
}

TEST_F(SmallRelease, RefusesTimeThatGoesBackwards) {
  EXPECT_EQ(error_after_writing("DRS.txt", "0.2\t1\t0\n0.1\t1\t0\n"),
            "DRS.txt:2: expected a time [s] that does not go backwards (0.2 … 4e+09), found '0.1'");
}

TEST_F(SmallRelease, RefusesColumnsTooMany) {
  EXPECT_EQ(error_after_writing("GPS.txt", "0.1\t1\t0\t9\n"), "GPS.txt:1: more columns than time, northing, easting");
}

TEST_F(SmallRelease, RefusesColumnsTooFew) {
  EXPECT_EQ(error_after_writing("GPS.txt", "0.1\t1\n0.2\t1\t1\n"),
            "GPS.txt:1: expected an easting [m], found the end of the line");
}

TEST_F(SmallRelease, RefusesAnOrderThatTheSensorsDoNotHave) {
  EXPECT_EQ(
      error_after_writing("Sensors_manager.txt", "0.0\t1\t1\n0.1\t2\t2\n"),
      "Sensors_manager.txt:2: expected row 1 of sensor 2 at the time that its table has, found row 2 at 0.100000 s");
  EXPECT_EQ(error_after_writing("Sensors_manager.txt", "0.0\t4\t1\n"),
            "Sensors_manager.txt:1: expected a sensor 1 (GPS), 2 (dead reckoning) or 3 (laser), found 4");
}

TEST_F(SmallRelease, RefusesAnEmptyLog) {
  EXPECT_EQ(error_after_writing("Sensors_manager.txt", ""),
            "Sensors_manager.txt: expected at least one reading, found none");
  EXPECT_EQ(error_after_writing("LASER.txt", ""), "LASER.txt: expected at least one scan, found none");
  EXPECT_EQ(error_after_writing("DRS.txt", " \r\n"), "DRS.txt: expected at least one speed and steering, found none");
}

TEST_F(SmallRelease, RefusesOneThatNamesReadingsThatAreNotThere) {
  EXPECT_EQ(
      error_after_writing("GPS.txt", ""),
      "Sensors_manager.txt:1: expected row 1 of sensor 1 at the time that its table has, found row 1 at 0.000000 s");
}

std::filesystem::path zip(const TemporaryFolder& folder) {
  const std::filesystem::path path = folder.path() / "release.zip";
  archive* writer = archive_write_new();
  archive_write_set_format_zip(writer);
  archive_write_open_filename(writer, path.c_str());
  for (const char* name : {"DRS.txt", "LASER.txt", "GPS.txt", "Sensors_manager.txt"}) {
    std::ifstream file(folder.path() / name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, (std::string("deep/inside/") + name).c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(text.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(writer, entry);
    archive_write_data(writer, text.data(), text.size());
    archive_entry_free(entry);
  }
  archive_write_free(writer);
  return path;
}

TEST_F(SmallRelease, IsTheSameFromAZip) {
  const AcfrLog log = read_acfr_ascii(zip(folder_));
  EXPECT_EQ(log.order.size(), 5u);
  EXPECT_EQ(log.scans.size(), 2u);
}

TEST_F(SmallRelease, RefusesAZipCutOffAnywhere) {
  const std::filesystem::path path = zip(folder_);
  const auto whole = std::filesystem::file_size(path);
  for (const double kept : {0.0, 0.1, 0.3, 0.6}) {
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(kept * static_cast<double>(whole)));
    EXPECT_NE(input_error_of([&] { read_acfr_ascii(path); }).find("release.zip"), std::string::npos) << kept;
  }
}

TEST_F(SmallRelease, RefusesAZipThatIsNone) {
  const auto path = folder_.write("release.zip", std::string(2000, '\xfe'));
  EXPECT_NE(input_error_of([&] { read_acfr_ascii(path); }).find("expected a zip or tar archive"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
