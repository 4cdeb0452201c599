// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/drive_file.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>

#include <boost/crc.hpp>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "little_endian.hpp"

namespace helixnav::runs {
namespace {

constexpr std::string_view drive_magic = "HELIXDRV";
constexpr std::uint32_t drive_version = 1;
constexpr std::size_t drive_header_bytes = 8 + 4;
constexpr std::size_t frame_bytes = 4 + 4 + 4;  // size of the block, its complement, CRC-32 of the block

/// Order of the alternatives of core::Event.
enum class Kind : std::uint8_t { odometry, scan, fix, lost };

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string framed(std::string_view block) {
  const auto size = static_cast<std::uint32_t>(block.size());
  std::string bytes;
  put_unsigned(bytes, size);
  put_unsigned(bytes, ~size);
  put_unsigned(bytes, crc_of(block));
  return bytes.append(block);
}

/// Up to 16 numbers: which of them are not +0, and their values.
template <std::size_t n>
void put_numbers(std::string& bytes, const std::array<double, n>& numbers) {
  static_assert(n <= 16);
  const auto is_put = [](double number) { return number != 0.0 || std::signbit(number); };
  unsigned mask = 0;
  for (std::size_t k = 0; k < n; ++k) mask |= is_put(numbers[k]) ? 1U << k : 0U;
  put_unsigned(bytes, static_cast<std::uint16_t>(mask));
  for (const double number : numbers) {
    if (is_put(number)) put(bytes, number);
  }
}

void put_appearance(std::string& bytes, const core::Appearance& appearance) {
  put_unsigned(bytes, static_cast<std::uint8_t>(appearance.is_given()));
  if (!appearance.is_given()) return;
  const std::string_view name = appearance.name.text();
  put_unsigned(bytes, static_cast<std::uint8_t>(name.size()));
  bytes += name;
  put_numbers<3>(bytes, {appearance.class_error, appearance.size_m, appearance.sigma_size_m});
}

void put_observation(std::string& bytes, const core::Observation& observation) {
  put_unsigned(bytes, static_cast<std::uint8_t>(observation.kind));
  std::array<double, 6> numbers{};
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < observation.z.size(); ++i) numbers[next++] = observation.z(i);
  for (Eigen::Index i = 0; i < observation.R.size(); ++i) numbers[next++] = observation.R.data()[i];
  put_numbers(bytes, numbers);
  put_appearance(bytes, observation.appearance);
}

void put_event(std::string& bytes, const core::Odometry& odometry) {
  const core::Pose2& T = odometry.T_before_after;
  std::array<double, 12> numbers{T.x_m, T.y_m, T.heading_rad};
  for (Eigen::Index i = 0; i < 9; ++i) numbers[static_cast<std::size_t>(3 + i)] = odometry.covariance.data()[i];
  put_numbers(bytes, numbers);
}

void put_event(std::string& bytes, const core::Scan& scan) {
  const core::Pose2& T = scan.T_robot_sensor;
  const core::FieldOfView& view = scan.field_of_view;
  put_numbers<8>(bytes, {T.x_m, T.y_m, T.heading_rad, view.min_range_m, view.max_range_m, view.min_bearing_rad,
                         view.max_bearing_rad, view.reach_m});
  put_unsigned(bytes, static_cast<std::uint32_t>(scan.observations.size()));
  for (const core::Observation& observation : scan.observations) put_observation(bytes, observation);
}

void put_event(std::string& bytes, const core::AbsoluteFix& fix) {
  const Eigen::Matrix2d& P = fix.covariance_m2;
  put_numbers<8>(bytes, {fix.position_world_m.x(), fix.position_world_m.y(), P(0, 0), P(1, 0), P(0, 1), P(1, 1),
                         fix.antenna_robot_m.x(), fix.antenna_robot_m.y()});
}

void put_event(std::string&, const core::Lost&) {}

std::string start_block(const core::PoseGaussian& start) {
  std::string block;
  std::array<double, 12> numbers{start.mean.x_m, start.mean.y_m, start.mean.heading_rad};
  for (Eigen::Index i = 0; i < 9; ++i) numbers[static_cast<std::size_t>(3 + i)] = start.covariance.data()[i];
  put_numbers(block, numbers);
  return block;
}

/// Reads the content of a block; throws InputError if it is not what it claims to be.
class Block {
 public:
  Block(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  bool is_read() const { return bytes_.left() == 0; }

  [[noreturn]] void refuse(const std::string& problem) const { throw core::InputError(where_ + problem); }

  core::PoseGaussian start() {
    const std::array<double, 12> numbers = take_numbers<12>();
    core::PoseGaussian start{pose(numbers.data()), Eigen::Map<const Eigen::Matrix3d>(numbers.data() + 3)};
    if (!is_read() || !start.mean.vector().allFinite() || !core::is_symmetric_positive_semidefinite(start.covariance)) {
      refuse("no start of a drive");
    }
    return start;
  }

  core::Event event() {
    const auto kind = take<std::uint8_t>();
    const auto t_ns = static_cast<core::Nanoseconds>(take<std::uint64_t>());
    try {
      core::Event event = event_of(kind, t_ns);
      core::check(event);
      return event;
    } catch (const core::PreconditionError& error) {
      refuse(error.what());
    }
  }

 private:
  template <class Unsigned>
  Unsigned take() {
    need(sizeof(Unsigned));
    return bytes_.take<Unsigned>();
  }

  void need(std::size_t size) const {
    if (bytes_.left() < size) refuse("a block ends within an event");
  }

  template <std::size_t n>
  std::array<double, n> take_numbers() {
    const auto mask = take<std::uint16_t>();
    std::array<double, n> numbers{};
    if ((static_cast<unsigned>(mask) >> n) != 0) refuse("more numbers than an event has");
    for (std::size_t k = 0; k < n; ++k) {
      if (((mask >> k) & 1) == 0) continue;
      need(sizeof(double));
      numbers[k] = bytes_.number();
    }
    return numbers;
  }

  /// Unchanged, not wrapped anew.
  static core::Pose2 pose(const double* numbers) {
    core::Pose2 pose;
    pose.x_m = numbers[0];
    pose.y_m = numbers[1];
    pose.heading_rad = numbers[2];
    return pose;
  }

  core::Event event_of(std::uint8_t kind, core::Nanoseconds t_ns) {
    switch (static_cast<Kind>(kind)) {
      case Kind::odometry:
        return odometry(t_ns);
      case Kind::scan:
        return scan(t_ns);
      case Kind::fix:
        return fix(t_ns);
      case Kind::lost:
        return core::Lost{t_ns};
    }
    refuse("an unknown kind of event");
  }

  core::Odometry odometry(core::Nanoseconds t_ns) {
    const std::array<double, 12> numbers = take_numbers<12>();
    return {t_ns, pose(numbers.data()), Eigen::Map<const Eigen::Matrix3d>(numbers.data() + 3)};
  }

  core::Scan scan(core::Nanoseconds t_ns) {
    const std::array<double, 8> numbers = take_numbers<8>();
    core::Scan scan{t_ns, pose(numbers.data()), {numbers[3], numbers[4], numbers[5], numbers[6], numbers[7]}, {}};
    for (auto left = take<std::uint32_t>(); left > 0; --left) scan.observations.push_back(observation());
    return scan;
  }

  core::Observation observation() {
    const auto kind = take<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(core::ObservationKind::range)) refuse("an unknown kind of observation");
    core::Observation observation;
    observation.kind = static_cast<core::ObservationKind>(kind);
    const std::array<double, 6> numbers = take_numbers<6>();
    const Eigen::Index n = core::dimension(observation.kind);
    observation.z = Eigen::Map<const Eigen::VectorXd>(numbers.data(), n);
    observation.R = Eigen::Map<const Eigen::MatrixXd>(numbers.data() + n, n, n);
    if (take<std::uint8_t>() != 0) observation.appearance = appearance();
    return observation;
  }

  core::Appearance appearance() {
    const auto size = take<std::uint8_t>();
    need(size);
    if (size > core::ClassName::most_bytes) refuse("a class with a longer name than there is");
    core::Appearance appearance;
    appearance.name = core::ClassName(bytes_.text(size));
    const std::array<double, 3> numbers = take_numbers<3>();
    appearance.class_error = numbers[0];
    appearance.size_m = numbers[1];
    appearance.sigma_size_m = numbers[2];
    return appearance;
  }

  core::AbsoluteFix fix(core::Nanoseconds t_ns) {
    const std::array<double, 8> numbers = take_numbers<8>();
    core::AbsoluteFix fix;
    fix.t_ns = t_ns;
    fix.position_world_m = {numbers[0], numbers[1]};
    fix.covariance_m2 = Eigen::Map<const Eigen::Matrix2d>(numbers.data() + 2);
    fix.antenna_robot_m = {numbers[6], numbers[7]};
    return fix;
  }

  LittleEndian bytes_;
  std::string where_;
};

/// The blocks of a file, one after the other.
class Blocks {
 public:
  Blocks(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes), rest_(bytes) {
    if (bytes.substr(0, drive_magic.size()) != drive_magic.substr(0, bytes.size()))
      refuse("no drive.bin: it does not begin with HELIXDRV");
    if (bytes.size() < drive_header_bytes) refuse("the file is cut short within its first bytes");
    rest_.text(drive_magic.size());
    const std::uint32_t found = rest_.small();
    if (found == drive_version) return;
    refuse("version " + std::to_string(found) + " of drive.bin; this program reads version " +
           std::to_string(drive_version));
  }

  /// False at the end, or before an incomplete block.
  bool next(std::string_view& block) {
    if (rest_.left() < frame_bytes) return false;
    at_ = bytes_.size() - rest_.left();
    const std::uint32_t size = rest_.small();
    if (rest_.small() != ~size) refuse_here("the size of a block is damaged");
    const std::uint32_t crc = rest_.small();
    if (rest_.left() < size) return false;
    block = rest_.text(size);
    if (crc_of(block) != crc) refuse_here("the checksum of a block does not fit: the file is damaged");
    return true;
  }

  std::string where() const { return path_ + ": byte " + std::to_string(at_) + ": "; }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { throw core::InputError(path_ + ": " + problem); }
  [[noreturn]] void refuse_here(const std::string& problem) const { throw core::InputError(where() + problem); }

  const std::string& path_;
  std::string_view bytes_;
  LittleEndian rest_;
  std::size_t at_ = 0;
};

}  // namespace

DriveFile::DriveFile(const std::string& path, const core::PoseGaussian& start)
    : file_(std::make_unique<files::AppendFile>(path)) {
  std::string bytes(drive_magic);
  put_unsigned(bytes, drive_version);
  file_->append(bytes + framed(start_block(start)));
}

DriveFile::~DriveFile() = default;

void DriveFile::add(const core::Event& event) {
  put_unsigned(block_, static_cast<std::uint8_t>(event.index()));
  put_unsigned(block_, static_cast<std::uint64_t>(core::time_of(event)));
  std::visit([&](const auto& one) { put_event(block_, one); }, event);
  if (std::holds_alternative<core::Scan>(event)) finish();
}

void DriveFile::end_input() {
  finish();
  file_->append(framed({}));
}

void DriveFile::finish() {
  if (block_.empty()) return;
  file_->append(framed(block_));
  block_.clear();
}

FedDrive read_drive(const std::string& path) {
  const std::string bytes = files::read_whole_file(path);
  Blocks blocks(path, bytes);
  std::string_view block;
  if (!blocks.next(block)) throw core::InputError(path + ": the file is cut short before the drive begins");
  FedDrive drive{Block(block, blocks.where()).start(), {}, 0};
  bool has_ended = false;
  core::Nanoseconds last_ns = std::numeric_limits<core::Nanoseconds>::min();
  while (blocks.next(block)) {
    has_ended = has_ended || block.empty();
    Block events(block, blocks.where());
    while (!events.is_read()) {
      drive.events.push_back(events.event());
      const core::Nanoseconds t_ns = core::time_of(drive.events.back());
      if (t_ns < last_ns) events.refuse("an event before the one before it");
      last_ns = t_ns;
    }
    if (!has_ended) drive.before_end_of_input = drive.events.size();
  }
  return drive;
}

}  // namespace helixnav::runs
