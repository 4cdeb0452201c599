// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/own_stream.hpp"

#include <algorithm>
#include <random>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* vehicle_text =
    "[odometry]\nwheelbase_m = 1.5\ntrack_m = 0.8\nsigma_along_m_per_sqrt_m = 0.02\nsigma_v_mps = 0.1\n"
    "sigma_heading_deg_per_sqrt_m = 0.5\nx_m = 0.4\n"
    "[[sensor]]\nname = \"near\"\nreach_m = 12\nview_deg = [-180, 180]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n"
    "[[sensor]]\nname = \"far\"\nx_m = 0.3\nreach_m = 40\nview_deg = [-90, 90]\nsigma_range_m = 0.1\n"
    "sigma_bearing_deg = 0.3\ndelay_s = 0.125\n";

/// A drive of random steps as lines in the order of their times, with odometry given in one of its forms.
Lines lines_of_drive(const std::string& kind, unsigned seed, int rows = 120) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<std::pair<double, std::string>> lines;  // time, line
  double x = 0.0, heading = 0.0;
  double t = uniform(0.0, 0.1);
  for (int i = 0; i < rows; ++i) {
    std::ostringstream odometry, near, far;
    odometry.precision(17);
    near.precision(17);
    far.precision(17);
    const double v = uniform(0.0, 2.0), turn = uniform(-0.2, 0.2);
    odometry << R"({"odometry": {"t": )" << t << ", ";
    if (kind == "increments") odometry << R"("dx": )" << 0.1 * v << R"(, "dheading_deg": )" << turn;
    if (kind == "velocities") odometry << R"("v": )" << v << R"(, "omega": )" << turn;
    if (kind == "steering") odometry << R"("v_kmh": )" << v << R"(, "steering": )" << turn;
    if (kind == "wheels") odometry << R"("v_left": )" << v << R"(, "v_right": )" << v + turn;
    if (kind == "poses") odometry << R"("x": )" << (x += v) << R"(, "y": 3, "heading": )" << (heading += turn);
    lines.emplace_back(t, odometry.str() + "}}");
    if (uniform(0.0, 1.0) < 0.6) {
      const double near_s = t + uniform(0.0, 0.05);
      near << R"({"detections": [{"sensor": "near", "id": 7, "t": )" << near_s << R"(, "range": )" << uniform(1.0, 12.0)
           << R"(, "bearing": 0.5}]})";
      lines.emplace_back(near_s, near.str());
    }
    if (uniform(0.0, 1.0) < 0.3) {  // at the odometry's own times, row by row
      for (int row = 0; row < 3; ++row) {
        far.str("");
        far << R"({"detections": {"sensor": "far", "t": )" << t + 0.125 + 0.06 << R"(, "range": )"
            << 3.0 + row + uniform(0.0, 0.5) << R"(, "bearing_deg": )" << 10.0 * row << "}}";
        lines.emplace_back(t + 0.125 + 0.06, far.str());
      }
    }
    t += uniform(0.07, 0.1);
  }
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Lines in_order;
  for (auto& line : lines) in_order.push_back(std::move(line.second));
  return in_order;
}

/// Everything that results from lines.
StreamedEvents streamed(OwnStream& stream, const Lines& lines) {
  StreamedEvents all;
  const auto append = [&](StreamedEvents next) {
    for (core::Event& event : next.recording.events) all.recording.events.push_back(std::move(event));
    for (auto& labels : next.recording.labels) all.recording.labels.push_back(std::move(labels));
    for (const std::size_t line : next.lines) all.lines.push_back(line);
    for (const RefusedLine& refused : next.refused) all.refused.push_back(refused);
    for (const std::string& remark : next.remarks) all.remarks.push_back(remark);
  };
  for (std::size_t i = 0; i < lines.size(); ++i) append(stream.take(lines[i], i + 1));
  append(stream.finish());
  return all;
}

/// Bit for bit.
void expect_same(const core::Event& a, const core::Event& b) {
  ASSERT_EQ(a.index(), b.index());
  EXPECT_EQ(core::time_of(a), core::time_of(b));
  if (const auto* odometry = std::get_if<core::Odometry>(&a)) {
    const auto& other = std::get<core::Odometry>(b);
    EXPECT_EQ(odometry->T_before_after.vector(), other.T_before_after.vector());
    EXPECT_EQ(odometry->covariance, other.covariance);
    return;
  }
  if (std::holds_alternative<core::Lost>(a)) return;
  const auto& scan = std::get<core::Scan>(a);
  const auto& other = std::get<core::Scan>(b);
  EXPECT_EQ(scan.T_robot_sensor.vector(), other.T_robot_sensor.vector());
  EXPECT_EQ(scan.field_of_view.max_range_m, other.field_of_view.max_range_m);
  EXPECT_EQ(scan.field_of_view.reach_m, other.field_of_view.reach_m);
  EXPECT_EQ(scan.field_of_view.min_bearing_rad, other.field_of_view.min_bearing_rad);
  ASSERT_EQ(scan.observations.size(), other.observations.size());
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    EXPECT_EQ(scan.observations[i].z, other.observations[i].z);
    EXPECT_EQ(scan.observations[i].R, other.observations[i].R);
  }
}

std::string text_of(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

void expect_events_of(const core::Recording& whole, const StreamedEvents& live) {
  ASSERT_TRUE(live.refused.empty()) << live.refused.front().why;
  ASSERT_EQ(live.recording.events.size(), whole.events.size());
  for (std::size_t i = 0; i < whole.events.size(); ++i) expect_same(live.recording.events[i], whole.events[i]);
}

class OwnStreamOf : public ::testing::TestWithParam<const char*> {};

TEST_P(OwnStreamOf, EachKindOfOdometryGivesTheEventsOfTheLogToTheLastBit) {
  const testing::TemporaryFolder folder;
  const Vehicle vehicle = read_vehicle(folder.write("vehicle.toml", vehicle_text));
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Lines lines = lines_of_drive(GetParam(), seed);
    core::Recording whole = make_recording(read_own_log(folder.write("log.jsonl", text_of(lines))), vehicle);
    while (!std::holds_alternative<core::Scan>(whole.events.back())) whole.events.pop_back();
    OwnStream stream(vehicle, true);
    const StreamedEvents live = streamed(stream, lines);
    expect_events_of(whole, live);
    EXPECT_EQ(live.recording.labels, whole.labels);
  }
}

/// Without the odometry of three periods of some seconds, which contain scans.
Lines with_gaps(const Lines& lines) {
  Lines kept;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool in_gap = (i / 60) % 4 == 2;
    if (!in_gap || lines[i].rfind(R"({"odometry")", 0) != 0) kept.push_back(lines[i]);
  }
  return kept;
}

// The uncertainty of a gap is determined by the rows before it alone; the stream has dropped some of them.
TEST_P(OwnStreamOf, GapsInTheOdometryGiveTheEventsOfTheLogToTheLastBit) {
  const testing::TemporaryFolder folder;
  const Vehicle vehicle = read_vehicle(folder.write("vehicle.toml", vehicle_text));
  const Lines lines = with_gaps(lines_of_drive(GetParam(), 11, 900));
  core::Recording whole = make_recording(read_own_log(folder.write("log.jsonl", text_of(lines))), vehicle);
  while (!std::holds_alternative<core::Scan>(whole.events.back())) whole.events.pop_back();
  OwnStream stream(vehicle, true);
  const StreamedEvents live = streamed(stream, lines);
  expect_events_of(whole, live);
}

TEST_P(OwnStreamOf, AVehicleThatWasCarriedIsInBothBeforeTheNextScan) {
  const testing::TemporaryFolder folder;
  const Vehicle vehicle = read_vehicle(folder.write("vehicle.toml", vehicle_text));
  Lines lines = lines_of_drive(GetParam(), 7);
  std::size_t middle = lines.size() / 2;
  while (lines[middle].rfind(R"({"odometry")", 0) != 0) ++middle;  // not within a scan of several rows
  const std::size_t at = lines[middle].find("\"t\": ");
  const double t = std::stod(lines[middle].substr(at + 5)) + 0.01;
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(middle) + 1,
               R"({"lost": {"t": )" + std::to_string(t) + "}}");
  const core::Recording whole = make_recording(read_own_log(folder.write("log.jsonl", text_of(lines))), vehicle);
  OwnStream stream(vehicle);
  const StreamedEvents live = streamed(stream, lines);
  ASSERT_TRUE(live.refused.empty()) << live.refused.front().why;
  const auto is_lost = [](const core::Event& event) { return std::holds_alternative<core::Lost>(event); };
  EXPECT_EQ(std::count_if(live.recording.events.begin(), live.recording.events.end(), is_lost), 1);
  ASSERT_LE(live.recording.events.size(), whole.events.size());
  for (std::size_t i = 0; i < live.recording.events.size(); ++i) {
    expect_same(live.recording.events[i], whole.events[i]);
  }
}

TEST(OwnStream, RefusesThatItWasCarriedBeforeAScanThatWasAnsweredOrWhereLandmarksAreKnownByName) {
  const testing::TemporaryFolder folder;
  const Vehicle vehicle = read_vehicle(folder.write("vehicle.toml", vehicle_text));
  Lines lines = lines_of_drive("velocities", 7);
  lines.emplace_back(R"({"lost": {"t": 0.001}})");
  OwnStream stream(vehicle);
  const StreamedEvents late = streamed(stream, lines);
  ASSERT_EQ(late.refused.size(), 1u);
  EXPECT_EQ(late.refused.front().key, "t");
  OwnStream by_name(vehicle, true);
  const StreamedEvents named = by_name.take(R"({"lost": {"t": 0.001}})", 1);
  ASSERT_EQ(named.refused.size(), 1u);
  EXPECT_EQ(named.refused.front().key, "lost");
}

INSTANTIATE_TEST_SUITE_P(Kinds, OwnStreamOf,
                         ::testing::Values("increments", "velocities", "steering", "wheels", "poses"));

class OwnStreamLines : public ::testing::Test {
 protected:
  StreamedEvents take(const std::string& line) { return stream_.take(line, ++number_); }
  std::size_t scans_of(const std::string& line) { return take(line).lines.size(); }
  void expect_refused(const std::string& line, const std::string& key, const std::string& words) {
    const StreamedEvents answer = take(line);
    ASSERT_EQ(answer.refused.size(), 1u) << line;
    EXPECT_EQ(answer.refused[0].line, number_);
    EXPECT_EQ(answer.refused[0].key, key) << answer.refused[0].why;
    EXPECT_NE(answer.refused[0].why.find(words), std::string::npos) << answer.refused[0].why;
    EXPECT_TRUE(answer.recording.events.empty());
  }

  static std::string odometry(double t_s) {
    return "{\"odometry\": {\"t\": " + std::to_string(t_s) + ", \"v\": 1, \"omega\": 0}}";
  }
  static std::string scan(double t_s) {
    return "{\"detections\": [{\"t\": " + std::to_string(t_s) + ", \"range\": 5, \"bearing\": 0}]}";
  }

  testing::TemporaryFolder folder_;
  Vehicle vehicle_ = read_vehicle(
      folder_.write("vehicle.toml",
                    "[odometry]\nsigma_v_mps = 0.1\n"
                    "[[sensor]]\nreach_m = 12\nview_deg = [-90, 90]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n"));
  OwnStream stream_{vehicle_};
  std::size_t number_ = 0;
};

TEST_F(OwnStreamLines, MakeAScanDueWhenOdometryHasReachedItsTime) {
  EXPECT_EQ(scans_of(odometry(0.0)), 0u);
  EXPECT_EQ(scans_of(scan(0.05)), 0u);
  EXPECT_EQ(scans_of(odometry(0.04)), 0u);
  EXPECT_EQ(scans_of(odometry(0.1)), 1u);
  EXPECT_EQ(scans_of(scan(0.1)), 1u) << "a list is a whole scan, and the odometry is there";
  EXPECT_EQ(scans_of(R"({"detections": {"t": 0.1, "range": 5, "bearing": 0}})"), 0u) << "answered before";
}

TEST_F(OwnStreamLines, KeepAScanOpenWhileItsRowsCome) {
  take(odometry(0.0));
  take(odometry(1.0));
  EXPECT_EQ(scans_of(R"({"detections": {"t": 0.5, "range": 5, "bearing": 0}})"), 0u);
  EXPECT_EQ(scans_of(R"({"detections": {"t": 0.5, "range": 6, "bearing": 0}})"), 0u);
  const StreamedEvents due = take(R"({"detections": {"t": 0.6}})");
  ASSERT_EQ(due.lines, std::vector<std::size_t>{3});
  EXPECT_EQ(std::get<core::Scan>(due.recording.events.back()).observations.size(), 2u);
}

TEST_F(OwnStreamLines, AreWovenInLateAsLongAsNothingLaterIsDone) {
  for (int i = 0; i <= 10; ++i) take(odometry(0.1 * i));
  EXPECT_EQ(scans_of(scan(0.35)), 1u);
  expect_refused(scan(0.25), "t", "late");
  EXPECT_EQ(scans_of(scan(0.95)), 1u);
  for (int i = 11; i <= 40; ++i) take(odometry(0.1 * i));
  expect_refused(scan(1.5), "t", "late");
  EXPECT_EQ(scans_of(scan(3.9)), 1u);
}

TEST_F(OwnStreamLines, ThatAreWrongAreRefusedWithTheirKeyAndLeaveNothingBehind) {
  take(odometry(0.0));
  expect_refused("{\"odometry\": {\"t\": 0.5, \"v\": 1", "", "no JSON");
  expect_refused(R"({"odometry": {"t": 0.5, "v": 1, "v": 2, "omega": 0}})", "v", "'v' is given twice");
  expect_refused("[1, 2]", "", "expected an object");
  expect_refused("{}", "", "holds no row");
  expect_refused(R"({"detections": []})", "", "a time alone");
  expect_refused(R"({"odometry": {"t": NaN, "v": 1, "omega": 0}})", "", "NaN and Infinity are no numbers of JSON");
  expect_refused(R"({"odometry": {"t": 0.5, "v": "nan", "omega": 0}})", "v", "expected a number");
  expect_refused(R"({"odometry": {"t": 0.5, "v": 1e999, "omega": 0}})", "", "larger than any");
  expect_refused(R"({"odometry": {"note": ")" + std::string(1 << 20, 'y') + R"("}})", "", "longer than 1 MiB");
  expect_refused(R"({"detections": [{"t": 0.1, "range": 5, "bearing": 0}, {"t": 0.2, "range": 5, "bearing": 1}]})", "t",
                 "a list is a whole scan, and this one has detections of 0.1 s and of 0.2 s");
  expect_refused(R"({"odometry": {"t": 0.5, "v": null, "omega": 0}})", "v", "an empty cell");
  expect_refused(R"({"odometry": {"t": 0.5, "v": [1], "omega": 0}})", "v", "expected a number or text");
  expect_refused(R"({"odometry": {"t": 0.5, "x": 1, "y": 0, "heading": 0}})", "odometry", "a stream has one kind");
  expect_refused(R"({"odometry": {"t": -0.1, "v": 1, "omega": 0}})", "t", "comes after odometry at 0 s");
  expect_refused(R"({"odometre": {}})", "odometre", "the nearest is 'odometry'");
  expect_refused(R"({"detections": [{"t": 0.1, "range": 5, "bearing": 0}, {"t": 0.1, "range": -5, "bearing": 0}]})",
                 "range", "greater than 0");
  expect_refused(R"({"detections": [{"t": 0.1, "range": 5, "bearing": 90}]})", "bearing", "_deg");
  expect_refused(R"({"detections": [{"t": 0.1, "x": 5, "y": 90}]})", "", "sigma_point_m");
  take(odometry(1.0));
  EXPECT_EQ(scans_of(scan(0.1)), 1u) << "and with one detection";
}

TEST_F(OwnStreamLines, OfColumnsThatAreNotUsedAndOfASensorWithoutANameAreTold) {
  const StreamedEvents odometry = take(R"({"odometry": {"t": 0, "v": 1, "omega": 0, "café": 1}})");
  ASSERT_EQ(odometry.remarks.size(), 1u);
  EXPECT_NE(odometry.remarks[0].find("column café is not used"), std::string::npos) << odometry.remarks[0];
  const StreamedEvents seen = take(R"({"detections": [{"t": 0.5, "range": 5, "bearing": 0, "sensor": "nobody"}]})");
  ASSERT_EQ(seen.remarks.size(), 1u);
  EXPECT_NE(seen.remarks[0].find("sensor 'nobody' is taken for the only [[sensor]]"), std::string::npos);
}

TEST_F(OwnStreamLines, OfOneWrongTimeDoNotMakeTheRestLate) {
  double t_s = 0.0;
  for (; t_s < 2.0; t_s += 0.0625) take(odometry(t_s));
  for (const double wrong_s : {2e9, 30.0}) {
    EXPECT_TRUE(take(odometry(wrong_s)).refused.empty()) << "waits";
    const StreamedEvents next = take(odometry(t_s));
    ASSERT_EQ(next.refused.size(), 1u) << wrong_s;
    EXPECT_NE(next.refused[0].why.find("ahead of the newest"), std::string::npos) << next.refused[0].why;
  }
  EXPECT_TRUE(take(odometry(1e8)).refused.empty());
  EXPECT_TRUE(take(odometry(1e8 + 0.1)).refused.empty()) << "the clock did jump";
  expect_refused(odometry(0.2), "t", "comes after");
  EXPECT_TRUE(take(odometry(2e8)).refused.empty());
  const StreamedEvents at_end = stream_.finish();
  ASSERT_EQ(at_end.refused.size(), 1u) << "nothing confirms it";
}

/// Of two sensors without a delay, the lines of one come 0.8 s later.
TEST(OwnStream, WaitsForASensorWhoseLinesArriveLate) {
  const testing::TemporaryFolder folder;
  for (const bool is_known : {false, true}) {
    const std::string late = is_known ? "arrives_late_s = 0.8\n" : "";
    const Vehicle vehicle = read_vehicle(
        folder.write("vehicle.toml",
                     "[odometry]\nsigma_v_mps = 0.1\n[[sensor]]\nname = \"a\"\nreach_m = 20\nview_deg = [-90, 90]\n"
                     "sigma_point_m = 0.1\n[[sensor]]\nname = \"b\"\nreach_m = 20\nview_deg = [-90, 90]\n"
                     "sigma_point_m = 0.1\n" +
                         late));
    Lines lines;
    for (int k = 0; k < 40; ++k) {
      const auto at = [](double t_s) { return R"({"t": )" + std::to_string(t_s) + ", "; };
      const double t_s = 0.1 * k;
      lines.push_back(R"({"odometry": )" + at(t_s) + R"("v": 1, "omega": 0}})");
      lines.push_back(R"({"detections": [)" + at(t_s) + R"("x": 5, "y": 1, "sensor": "a"}]})");
      if (k >= 8) lines.push_back(R"({"detections": [)" + at(t_s - 0.8) + R"("x": 5, "y": 2, "sensor": "b"}]})");
    }
    OwnStream stream(vehicle);
    const StreamedEvents live = streamed(stream, lines);
    EXPECT_EQ(live.refused.size(), is_known ? 0u : 32u);
    EXPECT_EQ(live.lines.size(), is_known ? 72u : 40u);
  }
}

TEST_F(OwnStreamLines, AfterAGapAreUsedWithTheMotionThroughIt) {
  const auto increment = [](double t_s) {
    return "{\"odometry\": {\"t\": " + std::to_string(t_s) +
           ", \"dx_m\": 1, \"dheading_rad\": 0, \"sigma_x_m\": 0.01, \"sigma_heading_rad\": 0.001}}";
  };
  for (int k = 0; k <= 30; ++k) take(increment(0.1 * k));
  for (const double t_s : {63.0, 63.1}) EXPECT_TRUE(take(increment(t_s)).refused.empty());
  double driven_m = 0.0;
  for (const core::Event& event : take(scan(63.05)).recording.events) {
    if (const auto* motion = std::get_if<core::Odometry>(&event)) driven_m += motion->T_before_after.x_m;
  }
  EXPECT_NEAR(driven_m, 32.5, 1e-9);
}

TEST_F(OwnStreamLines, OfAnIncrementThatWasSentTwiceAreRefused) {
  const auto increment = [](double t_s, double dx_m) {
    return "{\"odometry\": {\"t\": " + std::to_string(t_s) + ", \"dx_m\": " + std::to_string(dx_m) +
           ", \"dheading_rad\": 0, \"sigma_x_m\": 0.01, \"sigma_heading_rad\": 0.001}}";
  };
  take(increment(0.0, 0.0));
  take(increment(0.5, 2.0));
  expect_refused(increment(0.5, 2.0), "t", "repeats odometry at 0.5 s");
  EXPECT_TRUE(take(increment(0.5, 1.0)).refused.empty()) << "times are coarse";
  EXPECT_TRUE(take(increment(0.5, 1.0)).refused.empty());
}

TEST_F(OwnStreamLines, OfDetectionsThatWereSentTwiceAreRefused) {
  take(odometry(0.0));
  const auto row = [](double t_s, double range_m, const std::string& more) {
    return "{\"sensor\": \"near\", \"t\": " + std::to_string(t_s) + ", \"range\": " + std::to_string(range_m) +
           ", \"bearing\": 0.5" + more + "}";
  };
  const std::string list = "{\"detections\": [" + row(0.3, 4.0, "") + ", " + row(0.3, 5.0, "") + "]}";
  EXPECT_TRUE(take(list).refused.empty());
  expect_refused(list, "t", "repeats the detections of 0.3 s");
  const std::string empty = R"({"detections": [{"sensor": "near", "t": 0.4}]})";
  EXPECT_TRUE(take(empty).refused.empty());
  expect_refused(empty, "t", "repeats the detections of 0.4 s");
  EXPECT_TRUE(take("{\"detections\": " + row(0.5, 4.0, "") + "}").refused.empty());
  EXPECT_TRUE(take("{\"detections\": " + row(0.5, 5.0, "") + "}").refused.empty());
  expect_refused("{\"detections\": " + row(0.5, 4.0, "") + "}", "t", "repeats the detections of 0.5 s");
  std::size_t scans = 0;
  for (const core::Event& event : take(odometry(1.0)).recording.events) {
    const auto* seen = std::get_if<core::Scan>(&event);
    if (seen == nullptr) continue;
    ++scans;
    EXPECT_EQ(seen->observations.size(), seen->t_ns == 400'000'000 ? 0u : 2u);
  }
  EXPECT_EQ(scans, 3u);
}

TEST_F(OwnStreamLines, OfAnotherClockAreNotKeptForEver) {
  take(odometry(0.0));
  std::size_t refused = 0;
  for (std::size_t i = 0; i < OwnStream::most_waiting + 10; ++i) {
    refused += take(scan(1.0 + 0.01 * static_cast<double>(i))).refused.size();
  }
  EXPECT_EQ(refused, 10u);
}

TEST_F(OwnStreamLines, OfTruthAndFixesArePassedOverWithOneRemark) {
  EXPECT_EQ(take(R"({"fixes": {"t": 0, "x": 1, "y": 2}})").remarks.size(), 1u);
  EXPECT_TRUE(take(R"({"truth_poses": {"t": 0, "x": 1, "y": 2}})").remarks.empty());
  EXPECT_TRUE(take("").refused.empty());
}

TEST_F(OwnStreamLines, MixNamesAndNumbersAsIdentitiesOnlyWhereNamesCameFirst) {
  OwnStream numbers(vehicle_, true), names(vehicle_, true);
  const std::string name = R"({"detections": [{"t": 0, "range": 5, "bearing": 0, "id": "church"}]})";
  const std::string number = R"({"detections": [{"t": 0, "range": 6, "bearing": 0, "id": 17}]})";
  const std::string standing = R"({"odometry": {"t": 0, "v": 0, "omega": 0}})";
  EXPECT_EQ(streamed(names, {name, number, standing}).recording.labels,
            (std::vector<std::vector<core::Label>>{{0, 1}}));
  const StreamedEvents refused = streamed(numbers, {number, name, standing});
  ASSERT_EQ(refused.refused.size(), 1u);
  EXPECT_EQ(refused.refused[0].key, "id");
  EXPECT_EQ(refused.recording.labels, (std::vector<std::vector<core::Label>>{{17}}));
}

TEST(OwnStream, NeedsTheViewThatOnlyAWholeLogWouldTell) {
  const testing::TemporaryFolder folder;
  const auto error = [&](const std::string& sensor) {
    const Vehicle vehicle = read_vehicle(folder.write("vehicle.toml", "[odometry]\nsigma_v_mps = 0.1\n" + sensor));
    return testing::input_error_of([&] { OwnStream stream(vehicle); });
  };
  EXPECT_NE(error("").find("needs a [[sensor]]"), std::string::npos);
  EXPECT_NE(error("[[sensor]]\nview_deg = [-90, 90]\n").find("needs reach_m"), std::string::npos);
  EXPECT_NE(error("[[sensor]]\nreach_m = 12\n").find("needs view_deg"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
