// SPDX-License-Identifier: BSD-3-Clause
#include "map_factors_bytes.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <Eigen/Core>

#include "helixnav/core/errors.hpp"

namespace helixnav::runs {
namespace {

using core::MapFactors;
using Eigen::Index;

constexpr double largest_number =
    1e15;  // beyond, it is garbage: information on a landmark known to a micrometre is 1e12

void put_count(ByteStream& bytes, std::size_t count) { bytes.whole(static_cast<std::uint32_t>(count)); }

void put_integer(ByteStream& bytes, int value) { bytes.number(static_cast<std::int32_t>(value)); }

void put_pose(ByteStream& bytes, const core::Pose2& T) {
  for (const double number : {T.x_m, T.y_m, T.heading_rad}) bytes.number(number);
}

void put_vector(ByteStream& bytes, const Eigen::VectorXd& v) {
  for (Index i = 0; i < v.size(); ++i) bytes.number(v[i]);
}

void put_part(ByteStream& bytes, const MapFactors::Part& part) {
  put_count(bytes, part.variables.size());
  for (const int v : part.variables) put_integer(bytes, v);
  bytes.triangle(part.gaussian->information.full());
  put_vector(bytes, part.gaussian->vector);
  put_vector(bytes, part.gaussian->mean);
  bytes.number(part.gaussian->chi2);
  put_count(bytes, part.fix ? 1 : 0);
  if (!part.fix) return;
  bytes.whole(static_cast<std::uint64_t>(part.fix->t_ns));
  put_vector(bytes, part.fix->position_world_m);
  bytes.triangle(part.fix->covariance_m2);
  put_vector(bytes, part.fix->antenna_robot_m);
}

void put_phase(ByteStream& bytes, const MapFactors::Phase& phase) {
  put_integer(bytes, phase.revisits);
  put_integer(bytes, phase.host);
  put_pose(bytes, phase.T_host_entry);
  put_count(bytes, phase.parts.size());
  for (const MapFactors::Part& part : phase.parts) put_part(bytes, part);
}

/// Reads numbers off bytes of which nobody knows whether there are enough.
class FactorReader {
 public:
  FactorReader(LittleEndian& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  MapFactors map() {
    MapFactors map;
    map.start.mean = pose();
    map.start.covariance = triangle(3);
    map.world = integer();
    constexpr std::size_t variable_bytes = 4 + 3 * 8;
    map.variables.resize(count(variable_bytes));
    for (MapFactors::Variable& variable : map.variables) {
      variable.dim = integer();
      if (variable.dim != 2 && variable.dim != 3) refuse("a variable that is neither a pose nor a point");
      variable.value = numbers(3);
    }
    map.poses.resize(count(4));
    for (int& v : map.poses) v = variable_of(map);
    map.landmarks.resize(count(8));
    for (auto& [id, v] : map.landmarks) {
      id = integer();
      v = variable_of(map);
    }
    constexpr std::size_t least_phase_bytes = 4 + 4 + 3 * 8 + 4;
    map.phases.resize(count(least_phase_bytes));
    for (MapFactors::Phase& phase : map.phases) read(map, phase);
    if (bytes_.left() > 0) refuse("bytes behind its factors");
    return map;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { throw core::InputError(path_ + ": " + problem); }

  void need(std::size_t bytes) const {
    if (bytes_.left() < bytes) refuse("it is cut short within its factors");
  }

  std::int32_t integer() {
    need(4);
    return bytes_.integer();
  }

  /// Of things that take as many bytes each, at least.
  std::size_t count(std::size_t bytes_each) {
    const auto count = static_cast<std::size_t>(static_cast<std::uint32_t>(integer()));
    need(count * bytes_each);
    return count;
  }

  double number() {
    need(8);
    const double number = bytes_.number();
    if (!(std::abs(number) <= largest_number)) refuse("a number of its factors is not finite or beyond 1e15");
    return number;
  }

  Eigen::VectorXd numbers(Index size) {
    Eigen::VectorXd v(size);
    for (Index i = 0; i < size; ++i) v[i] = number();
    return v;
  }

  core::Pose2 pose() { return core::Pose2(Eigen::Vector3d(numbers(3))); }

  Eigen::MatrixXd triangle(Index rows) {
    need(static_cast<std::size_t>(8 * rows * (rows + 1) / 2));
    Eigen::MatrixXd A(rows, rows);
    for (Index i = 0; i < rows; ++i) {
      for (Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = number();
    }
    return A;
  }

  int variable_of(const MapFactors& map) {
    const int v = integer();
    if (v < 0 || v >= static_cast<int>(map.variables.size())) refuse("a factor of a variable that is not there");
    return v;
  }

  void read(const MapFactors& map, MapFactors::Phase& phase) {
    phase.revisits = integer();
    phase.host = integer();
    phase.T_host_entry = pose();
    constexpr std::size_t least_part_bytes = 4 + 2 * 4;
    phase.parts.resize(count(least_part_bytes));
    for (MapFactors::Part& part : phase.parts) read(map, part);
  }

  void read(const MapFactors& map, MapFactors::Part& part) {
    part.variables.resize(count(4));
    if (part.variables.size() < 2) refuse("a factor of fewer than two variables");
    for (int& v : part.variables) v = variable_of(map);
    const auto rows = 2 * static_cast<Index>(part.variables.size()) - 1;
    auto gaussian = std::make_shared<core::RelativeGaussian>();
    gaussian->information = triangle(rows);
    gaussian->vector = numbers(rows);
    gaussian->mean = numbers(rows);
    gaussian->chi2 = number();
    part.gaussian = std::move(gaussian);
    if (integer() == 0) return;
    part.fix.emplace();
    need(8);
    part.fix->t_ns = static_cast<core::Nanoseconds>(bytes_.take<std::uint64_t>());
    part.fix->position_world_m = numbers(2);
    part.fix->covariance_m2 = triangle(2);
    part.fix->antenna_robot_m = numbers(2);
  }

  LittleEndian& bytes_;
  const std::string& path_;
};

}  // namespace

void put_factors(ByteStream& bytes, const MapFactors& map) {
  put_pose(bytes, map.start.mean);
  bytes.triangle(map.start.covariance);
  put_integer(bytes, map.world);
  put_count(bytes, map.variables.size());
  for (const MapFactors::Variable& variable : map.variables) {
    put_integer(bytes, variable.dim);
    put_vector(bytes, variable.value);
  }
  put_count(bytes, map.poses.size());
  for (const int v : map.poses) put_integer(bytes, v);
  put_count(bytes, map.landmarks.size());
  for (const auto& [id, v] : map.landmarks) {
    put_integer(bytes, id);
    put_integer(bytes, v);
  }
  put_count(bytes, map.phases.size());
  for (const MapFactors::Phase& phase : map.phases) put_phase(bytes, phase);
}

MapFactors take_factors(LittleEndian& bytes, const std::string& path) { return FactorReader(bytes, path).map(); }

}  // namespace helixnav::runs
