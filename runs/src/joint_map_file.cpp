// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/joint_map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <openssl/evp.h>

#include "byte_stream.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/files/file.hpp"
#include "little_endian.hpp"
#include "map_factors_bytes.hpp"

namespace helixnav::runs {
namespace {

constexpr std::string_view magic = "HELIXMAP";
constexpr std::uint32_t dense_version = 1;
constexpr std::uint32_t factors_version = 2;
constexpr std::size_t digest_bytes = 32;
constexpr std::size_t header_bytes = 8 + 4 + 4 + 4 + 8;  // magic, version, landmarks, next name, reach

/// SHA-256 of bytes that come in pieces.
class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void take(std::string_view bytes) { check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1); }

  std::string result() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1 && length == digest_bytes);
    return {reinterpret_cast<const char*>(digest.data()), digest_bytes};
  }

 private:
  static void check(bool is_fine) {
    if (!is_fine) throw core::NumericalError("map.bin: SHA-256 is not to be had");
  }

  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.take(bytes);
  return digest.result();
}

/// Of a dense map.
std::size_t size_for(std::size_t landmarks) {
  const std::size_t rows = 3 + 2 * landmarks;
  return header_bytes + 12 * landmarks + 8 * (rows + rows * (rows + 1) / 2) + digest_bytes;
}

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw core::InputError(path + ": " + problem);
}

void check_size_of_dense(const std::string& path, std::size_t landmarks, std::size_t bytes) {
  if (landmarks > most_joint_landmarks) {
    refuse(path, "says that it holds " + std::to_string(landmarks) + " landmarks; expected at most " +
                     std::to_string(most_joint_landmarks));
  }
  if (bytes != size_for(landmarks)) {
    refuse(path, "the file has " + std::to_string(bytes) + " bytes; a map of " + std::to_string(landmarks) +
                     " landmarks has " + std::to_string(size_for(landmarks)) + ": it is cut short or damaged");
  }
}

/// What the head of a complete file says.
struct Head {
  bool has_factors = false;
  std::size_t landmarks = 0;
};

Head check_frame(const std::string& path, std::string_view bytes) {
  if (bytes.size() < header_bytes + digest_bytes || bytes.substr(0, magic.size()) != magic) {
    refuse(path,
           bytes.empty() ? "the file is empty; expected a map.bin" : "no map.bin: it does not begin with HELIXMAP");
  }
  LittleEndian header(bytes.substr(magic.size()));
  const std::uint32_t found = header.small();
  if (found != dense_version && found != factors_version) {
    refuse(path, "version " + std::to_string(found) + " of map.bin; this program reads versions 1 and 2");
  }
  const Head head{found == factors_version, header.small()};
  if (!head.has_factors) check_size_of_dense(path, head.landmarks, bytes.size());
  const std::string_view body = bytes.substr(0, bytes.size() - digest_bytes);
  if (bytes.substr(body.size()) != digest_of(body))
    refuse(path, "the checksum does not fit: the file is damaged or cut short");
  return head;
}

// Beyond these a map is garbage, like the numbers of a log (docs/fuzzing.md).
constexpr double most_coordinate_m = 1e8;
constexpr double most_reach_m = 1e5;
constexpr double most_variance = 1e12;
constexpr core::LandmarkId most_name = 10'000'000;  // lists by name are as long as the last name

bool is_place(const Eigen::Vector2d& point_m) {
  return point_m.allFinite() && point_m.cwiseAbs().maxCoeff() <= most_coordinate_m;
}

/// No correlation exceeds one, except for what solving a large map loses to rounding. O(N²): a full factorisation would
/// reveal more, and take seconds.
bool can_be_covariance(const Eigen::MatrixXd& P) {
  if (!P.allFinite() || P.diagonal().minCoeff() < 0.0 || P.diagonal().maxCoeff() > most_variance) return false;
  const double rounding = 1e-6 * P.diagonal().maxCoeff();
  const Eigen::VectorXd deviations = P.diagonal().cwiseSqrt();
  for (Eigen::Index j = 0; j < P.cols(); ++j) {
    if (((P.col(j).cwiseAbs() - deviations(j) * deviations).array() > rounding).any()) return false;
  }
  return core::is_symmetric_positive_semidefinite(P.topLeftCorner<3, 3>());
}

/// What another program may have written.
void check_content(const std::string& path, const core::JointMap& map) {
  core::LandmarkId last = -1;
  for (const core::LandmarkId id : map.joint.ids) {
    if (id <= last || id >= map.next_name) refuse(path, "names of landmarks are not ascending below the next name");
    last = id;
  }
  if (map.next_name < 0 || map.next_name > most_name) {
    refuse(path, "expected the next name from 0 to " + std::to_string(most_name) + ", found " +
                     std::to_string(map.next_name));
  }
  if (!(map.reach_m >= 0.0 && map.reach_m <= most_reach_m)) {
    refuse(path, "expected the reach of a sensor, 0 to 100 km");
  }
  const std::vector<Eigen::Vector2d>& points_m = map.joint.points_m;
  if (!is_place(map.joint.pose.position_m()) || !std::isfinite(map.joint.pose.heading_rad) ||
      !std::all_of(points_m.begin(), points_m.end(), is_place)) {
    refuse(path, "expected finite numbers, and coordinates within 1e8 m");
  }
  if (!can_be_covariance(map.joint.covariance)) {
    refuse(path, "its covariance is none: variances from 0 to 1e12 and correlations of at most one are expected");
  }
  for (const Eigen::Matrix2d& P : map.covariances_m2) {
    if (!core::is_symmetric_positive_semidefinite(P) || P.diagonal().maxCoeff() > most_variance) {
      refuse(path, "the covariance of a landmark is none");
    }
  }
  const auto is_negative = [](int count) { return count < 0; };
  if (std::any_of(map.observations.begin(), map.observations.end(), is_negative)) {
    refuse(path, "a landmark was observed less than never");
  }
}

/// There must be enough bytes.
Eigen::MatrixXd triangle_of(LittleEndian& bytes, Eigen::Index rows) {
  Eigen::MatrixXd A(rows, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = bytes.number();
  }
  return A;
}

void check_parts(const core::JointMap& map) {
  const core::JointGaussian& joint = map.joint;
  const std::size_t n = joint.ids.size();
  const bool has_marginals = map.factors != nullptr && joint.covariance.rows() == 3 && map.covariances_m2.size() == n;
  const bool has_any_covariance = has_marginals || (map.has_covariance() && n <= most_joint_landmarks);
  if (!has_any_covariance || joint.covariance.rows() != joint.covariance.cols() || joint.points_m.size() != n ||
      map.states.size() != n || map.observations.size() != n) {
    throw core::PreconditionError("put_joint_map: the parts of the map do not fit, or it is too large");
  }
}

/// Every landmark of the map, at its name.
void check_names(const std::string& path, const core::JointMap& map) {
  auto known = map.factors->landmarks.begin();
  for (const core::LandmarkId id : map.joint.ids) {
    while (known != map.factors->landmarks.end() && known->first < id) ++known;
    if (known == map.factors->landmarks.end() || known->first != id) {
      refuse(path, "landmark " + std::to_string(id) + " is in none of its factors");
    }
  }
}

/// What a map with factors has besides them, and whether they are solved.
constexpr std::uint32_t dense = 1, unsolved = 2;

std::uint32_t kind_of(const core::JointMap& map) {
  return (map.has_covariance() ? dense : 0U) | (map.factors->is_solved ? 0U : unsolved);
}

/// What comes behind the places of the landmarks in a map with factors.
void read_factors(const std::string& path, LittleEndian& bytes, core::JointMap& map) {
  const auto rows = map.rows_with_landmarks();
  const std::uint32_t kind = bytes.small();
  if (kind > (dense | unsolved)) refuse(path, "an unknown kind of map");
  const bool is_dense = (kind & dense) != 0;
  const std::size_t numbers = static_cast<std::size_t>(
      is_dense ? rows * (rows + 1) / 2 : 6 + 3 * static_cast<Eigen::Index>(map.joint.ids.size()));
  if (bytes.left() < 8 * numbers) refuse(path, "it is cut short within its covariance");
  map.joint.covariance = triangle_of(bytes, is_dense ? rows : 3);
  for (std::size_t i = 0; !is_dense && i < map.joint.ids.size(); ++i) {
    map.covariances_m2.emplace_back(triangle_of(bytes, 2));
  }
  core::MapFactors factors = take_factors(bytes, path);
  factors.is_solved = (kind & unsolved) == 0;
  map.factors = std::make_shared<const core::MapFactors>(std::move(factors));
  check_names(path, map);
}

}  // namespace

void put_joint_map(const core::JointMap& map, const std::function<void(std::string_view)>& take) {
  check_parts(map);
  const core::JointGaussian& joint = map.joint;
  const std::size_t n = joint.ids.size();
  Digest digest;
  ByteStream bytes([&](std::string_view block) {
    digest.take(block);
    take(block);
  });
  bytes.text(magic);
  bytes.whole(map.factors == nullptr ? dense_version : factors_version);
  bytes.whole(static_cast<std::uint32_t>(n));
  bytes.number(static_cast<std::int32_t>(map.next_name));
  bytes.number(map.reach_m);
  for (std::size_t i = 0; i < n; ++i) {
    bytes.number(static_cast<std::int32_t>(joint.ids[i]));
    bytes.number(static_cast<std::int32_t>(map.states[i]));
    bytes.number(static_cast<std::int32_t>(map.observations[i]));
  }
  for (const double coordinate : {joint.pose.x_m, joint.pose.y_m, joint.pose.heading_rad}) bytes.number(coordinate);
  for (const Eigen::Vector2d& point_m : joint.points_m) {
    bytes.number(point_m.x());
    bytes.number(point_m.y());
  }
  if (map.factors != nullptr) bytes.whole(kind_of(map));
  bytes.triangle(joint.covariance);
  for (const Eigen::Matrix2d& covariance_m2 : map.covariances_m2) bytes.triangle(covariance_m2);
  if (map.factors != nullptr) put_factors(bytes, *map.factors);
  bytes.pass_on();
  take(digest.result());
}

std::string joint_map_bytes(const core::JointMap& map) {
  std::string bytes;
  put_joint_map(map, [&](std::string_view block) { bytes += block; });
  return bytes;
}

core::JointMap read_joint_map(const std::string& path) {
  const std::string file = files::read_whole_file(path);
  const auto [has_factors, n] = check_frame(path, file);
  LittleEndian bytes(std::string_view(file).substr(0, file.size() - digest_bytes).substr(magic.size() + 8));
  constexpr std::size_t landmark_bytes = 12 + 16;
  if (has_factors && bytes.left() < header_bytes + 3 * 8 + n * landmark_bytes) {
    refuse(path, "it is cut short within its landmarks");
  }
  core::JointMap map;
  map.next_name = bytes.integer();
  map.reach_m = bytes.number();
  for (std::size_t i = 0; i < n; ++i) {
    map.joint.ids.push_back(bytes.integer());
    const std::uint32_t state = bytes.small();
    if (state > static_cast<std::uint32_t>(core::LandmarkState::mature)) refuse(path, "an unknown state of a landmark");
    map.states.push_back(static_cast<core::LandmarkState>(state));
    map.observations.push_back(bytes.integer());
  }
  const double x_m = bytes.number();
  const double y_m = bytes.number();
  map.joint.pose.x_m = x_m;
  map.joint.pose.y_m = y_m;
  map.joint.pose.heading_rad = bytes.number();
  for (std::size_t i = 0; i < n; ++i) {
    const double point_x_m = bytes.number();
    map.joint.points_m.emplace_back(point_x_m, bytes.number());
  }
  if (has_factors) {
    read_factors(path, bytes, map);
  } else {
    map.joint.covariance = triangle_of(bytes, static_cast<Eigen::Index>(3 + 2 * n));
  }
  check_content(path, map);
  return map;
}

}  // namespace helixnav::runs
