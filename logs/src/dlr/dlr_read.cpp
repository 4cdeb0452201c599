// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dlr_frame.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "input_files.hpp"
#include "plausible.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

/// Position of the camera on the robot, dlr_kurlbaum2009 §3.2.2, in the file's axes.
const Eigen::Vector2d published_camera_offset_m(0.0179777, -0.0808609);

/// The camera's field of view for lines.
constexpr core::FieldOfView lines_field{0.0, std::numeric_limits<double>::infinity(), -0.75, 0.75};

/// Joins lines that end in a backslash with the next one; line ends move behind the joined line, so that the numbers of
/// all later lines are unchanged.
void join_continued_lines(std::string& text) {
  std::string joined;
  joined.reserve(text.size());
  std::size_t owed = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t end = text[i] == '\\' ? text.find_first_not_of(" \t\r", i + 1) : std::string::npos;
    if (end != std::string::npos && text[end] == '\n') {
      joined += ' ';
      ++owed;
      i = end;
      continue;
    }
    if (text[i] == '\n') joined.append(std::exchange(owed, 0), '\n');
    joined += text[i];
  }
  text = std::move(joined);
}

class DlrReader {
 public:
  DlrReader(std::string_view text, const std::filesystem::path& path, const core::Pose2& T_robot_camera)
      : cursor_(text, path.string()), T_robot_camera_(T_robot_camera) {
    recording_.name = path.filename().string();
  }

  core::Recording read() {
    while (!cursor_.at_end()) {
      const std::string_view keyword = cursor_.word();
      if (keyword.front() == '#') {
        cursor_.skip_line();
      } else if (keyword == "STEP") {
        read_step();
      } else if (keyword == "LANDMARK_C" || keyword == "LANDMARK") {
        read_circle();
      } else if (keyword == "LANDMARK_L") {
        read_line();
      } else {
        cursor_.fail("unknown keyword '" + std::string(keyword.substr(0, 24)) +
                     "'; expected STEP, LANDMARK_C, LANDMARK, LANDMARK_L or #");
      }
    }
    if (recording_.events.empty()) cursor_.fail("no STEP in this file");
    return std::move(recording_);
  }

 private:
  enum class Content { nothing, circles, lines };

  void read_step() {
    if (cursor_.word().empty()) cursor_.fail("expected the name of the image after STEP");
    Eigen::Vector2d motion_m;
    motion_m.x() = cursor_.number_between(-most_motion_m, most_motion_m, "dX [m]");
    motion_m.y() = cursor_.number_between(-most_motion_m, most_motion_m, "dY [m]");
    const double turn_rad = cursor_.number_between(-most_turn_rad, most_turn_rad, "dPhi [rad]");
    Eigen::Matrix3d C;
    C(0, 0) = cursor_.number("the covariance CXX of the step [m^2]");
    C(0, 1) = C(1, 0) = cursor_.number("the covariance CXY of the step [m^2]");
    C(1, 1) = cursor_.number("the covariance CYY of the step [m^2]");
    C(0, 2) = C(2, 0) = cursor_.number("the covariance CXPhi of the step [m rad]");
    C(1, 2) = C(2, 1) = cursor_.number("the covariance CYPhi of the step [m rad]");
    C(2, 2) = cursor_.number("the covariance CPhiPhi of the step [rad^2]");
    if (const auto fault = fault_of_covariance(C)) cursor_.fail("the covariance of the step " + *fault);
    cursor_.end_line("a STEP has (10 after the keyword)");

    const Eigen::Vector2d forward_left_m = from_dlr_axes(motion_m);
    core::Odometry odometry;
    odometry.t_ns = core::nanoseconds_from_seconds(static_cast<double>(recording_.labels.size()));
    odometry.T_before_after = core::Pose2(forward_left_m.x(), forward_left_m.y(), turn_rad);
    odometry.covariance = from_dlr_axes(C);
    core::Scan scan;
    scan.t_ns = odometry.t_ns;
    scan.T_robot_sensor = content_ == Content::lines ? T_robot_camera_ : core::Pose2();
    if (content_ == Content::lines) scan.field_of_view = lines_field;
    recording_.events.emplace_back(odometry);
    recording_.events.emplace_back(std::move(scan));
    recording_.labels.emplace_back();
  }

  void read_circle() {
    expect_content(Content::circles);
    Eigen::Vector2d point_m;
    point_m.x() = cursor_.number_between(-most_distance_m, most_distance_m, "pX of the circle [m]");
    point_m.y() = cursor_.number_between(-most_distance_m, most_distance_m, "pY of the circle [m]");
    cursor_.number("the quality of the circle");
    Eigen::Matrix2d C;
    C(0, 0) = cursor_.number("the covariance CXX of the circle [m^2]");
    C(0, 1) = C(1, 0) = cursor_.number("the covariance CXY of the circle [m^2]");
    C(1, 1) = cursor_.number("the covariance CYY of the circle [m^2]");
    if (const auto fault = fault_of_covariance(C)) cursor_.fail("the covariance of the circle " + *fault);
    add(core::make_cartesian(from_dlr_axes(point_m), from_dlr_axes(C)));
  }

  void read_line() {
    expect_content(Content::lines);
    for (const char* what : {"x bottom", "y bottom", "x top", "y top"}) cursor_.number(what);
    const double bearing_rad =
        cursor_.number_between(-2.0 * core::pi, 2.0 * core::pi, "the bearing alpha of the line [rad]");
    cursor_.number("the slant beta of the line [rad]");
    cursor_.number("the quality of the line");
    const double sigma_rad = cursor_.number("the standard deviation of the line's bearing [rad]");
    if (!(sigma_rad > 0.0)) cursor_.fail("the standard deviation of the line's bearing must be positive");
    if (const auto fault = fault_of_covariance(Eigen::Matrix<double, 1, 1>(sigma_rad * sigma_rad))) {
      cursor_.fail("the standard deviation of the line's bearing, squared, " + *fault);
    }
    add(core::make_bearing(bearing_rad, sigma_rad));
  }

  /// The first landmark of a file decides what all scans of the file are, including those before it.
  void expect_content(Content content) {
    if (recording_.events.empty()) cursor_.fail("a landmark before the first STEP");
    if (content_ == content) return;
    if (content_ != Content::nothing) cursor_.fail("circles and lines in one file");
    content_ = content;
    if (content != Content::lines) return;
    for (core::Event& event : recording_.events) {
      if (auto* scan = std::get_if<core::Scan>(&event)) {
        scan->T_robot_sensor = T_robot_camera_;
        scan->field_of_view = lines_field;
      }
    }
  }

  void add(const core::Observation& observation) {
    core::Scan& scan = std::get<core::Scan>(recording_.events.back());
    check_count(cursor_, scan.observations.size());
    std::vector<core::Label> ids{read_id()};
    while (!cursor_.at_line_end()) ids.push_back(read_id());
    cursor_.skip_line();
    if (ids.size() > 1) {
      recording_.shared_observations.push_back({recording_.labels.size() - 1, scan.observations.size(), ids});
    }
    scan.observations.push_back(observation);
    recording_.labels.back().push_back(ids.front());
  }

  core::Label read_id() {
    const core::Label id = read_name(cursor_, "an identifier of the landmark (-1: none)");
    if (id < core::no_label) cursor_.fail("identifiers are -1 (none) or not negative, found " + std::to_string(id));
    return id;
  }

  TextCursor cursor_;
  core::Pose2 T_robot_camera_;
  Content content_ = Content::nothing;
  core::Recording recording_;
};

std::optional<DlrCamera> camera_beside(const std::filesystem::path& path) {
  std::optional<std::filesystem::path> found;
  std::error_code ignored;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".cam") continue;
    if (found) return std::nullopt;  // several runs in one folder: unknown which one it belongs to
    found = entry.path();
  }
  if (!found) return std::nullopt;
  return read_dlr_camera(*found);
}

core::Pose2 camera_pose(const std::filesystem::path& path, const DlrOptions& options) {
  const std::optional<DlrCamera> camera = options.camera ? options.camera : camera_beside(path);
  if (camera) return bearing_sensor_pose(*camera);
  const Eigen::Vector2d position_m = from_dlr_axes(published_camera_offset_m);
  return {position_m.x(), position_m.y(), 0.0};
}

template <class Action>
void for_each_bearing(core::Recording& recording, Action&& action) {
  for (core::Event& event : recording.events) {
    auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (core::Observation& observation : scan->observations) {
      if (observation.kind == core::ObservationKind::bearing) action(observation.z[0]);
    }
  }
}

/// Bearings counted from ahead, counter-clockwise. The camera's field is narrower than ±π/4, so a mean shows where 0 is.
void count_bearings_from_ahead(core::Recording& recording, DlrBearingZero zero) {
  if (zero == DlrBearingZero::from_file) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for_each_bearing(recording, [&sum](double b) { sum += Eigen::Vector2d(std::cos(b), std::sin(b)); });
    zero = -sum.y() > sum.x() ? DlrBearingZero::left : DlrBearingZero::ahead;
  }
  const double offset_rad = zero == DlrBearingZero::left ? core::pi / 2 : 0.0;
  for_each_bearing(recording, [offset_rad](double& b) { b = core::wrap_to_pi(b + offset_rad); });
}

}  // namespace

core::Recording read_dlr(const std::filesystem::path& path, const DlrOptions& options) {
  std::string text = read_file(path);
  join_continued_lines(text);
  core::Recording recording = DlrReader(text, path, camera_pose(path, options)).read();
  count_bearings_from_ahead(recording, options.bearing_zero);
  estimate_missing_field_of_view(recording);
  recording.extraneous_per_scan = 0.0;
  recording.labels_are_given = true;  // by hand: with them the log is the problem that its authors published
  return recording;
}

}  // namespace helixnav::logs
