// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "associate.hpp"
#include "genealogy.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/worker_pool.hpp"
#include "helixnav/fastslam/fast_slam.hpp"
#include "realise.hpp"
#include "repeated_looks.hpp"

namespace helixnav::fastslam {

struct FastSlam::Impl {
  Impl(const std::vector<core::PoseGaussian>& starts, const Options& chosen, std::uint64_t seed);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void begin_with(const std::vector<core::PointGaussian>& landmarks);
  core::StepReport update(const core::Scan& scan, const std::vector<KnownName>* names, std::size_t robot);
  std::vector<core::MapLandmark> map_of(std::size_t particle) const;
  std::vector<core::MixedLandmark> mixture() const;
  MemoryReport memory() const;

  /// What belongs to a robot: the poses of all particles, and its motion.
  struct Robot {
    std::vector<core::Pose2> poses;        ///< [particle]
    std::optional<core::Odometry> motion;  ///< since its last scan
    core::PoseGaussian mean;               ///< at its last scan
    core::Pose2 T_look_robot;              ///< since its last look
    std::uint16_t look = 0;
    bool has_looked = false;
    RepeatedLooks repeated;
  };

  /// One worker's share of particles, hypotheses and nodes.
  struct Worker {
    explicit Worker(bool alone) : pool(alone) {}
    NodePool pool;
    AssociationScratch association;
    RealiseScratch realise;
  };

  Options options;
  core::RandomStream random;
  core::WorkerPool threads;
  std::vector<Worker> workers;
  Lineages lineages;
  std::map<KnownName, LineageId> named;
  std::map<LineageId, KnownName> names_of_lineages;

  std::vector<Robot> robots;
  std::vector<double> log_weight;   ///< [particle], normalised
  std::vector<PersistentMap> maps;  ///< [particle]
  std::size_t best = 0;
  Genealogy genealogy;
  core::CloudReport cloud;
  std::size_t most_node_bytes = 0;
  std::int64_t step = 0;
  std::uint16_t looks = 0;  ///< of all robots, modulo 2^16
  int scans_since_resampling = 0;
  std::size_t swept_at = 0;  ///< lineages given when unused ones were last looked for

  // Working memory of a scan.
  HypothesisSet set;
  std::vector<double> set_log_weight, uniforms;
  std::vector<std::pair<LineageId, Eigen::Vector2d>> innovations;
  std::vector<Eigen::Vector3d> normals, new_poses;
  std::vector<std::uint32_t> chosen, parents;  ///< [new particle] hypothesis; particle of before
  std::vector<PersistentMap> new_maps;

  /// Calls f(worker, first, end) for blocks of a few neighbours; which worker takes a block changes no result.
  template <class Function>
  void for_blocks(std::size_t count, Function&& f) {
    constexpr std::size_t block = 32;
    const std::size_t blocks = (count + block - 1) / block, slices = workers.size();
    threads.for_each(slices, [&](std::size_t s) {
      for (std::size_t b = s * blocks / slices; b < (s + 1) * blocks / slices; ++b) {
        f(workers[s], b * block, std::min(count, (b + 1) * block));
      }
    });
  }

  core::Odometry motion_of(const Robot& robot, core::Nanoseconds t_ns) const;
  void propose(const Robot& robot, const core::Odometry& motion, std::size_t observations);
  void associate(const Associator& associator, const std::vector<Choice>& known);
  void split(const Associator& associator);
  void append_children(const Associator& associator, std::size_t observation);
  void prune();
  void weigh(std::size_t robot);
  void count_repeated(const Associator& associator, std::size_t heaviest, const Hypothesis& before, Robot& robot);
  void choose(bool sees);
  void resample();
  bool repeats(std::size_t k) const;
  void draw_poses();
  std::vector<LineageId> begin_lineages(const PreparedScan& scan, const std::vector<KnownName>* names);
  void take_over_maps();
  void realise(const MapUpdate& map_update);
  void take_over_particles(std::size_t robot);
  void settle();
  void sweep_lineages();
  void drive(Robot& robot, const core::Odometry& motion, const core::Pose2& T_robot_sensor);
  std::vector<Choice> known_choices(const std::vector<KnownName>& names) const;
  Hypothesis before_scan(const Hypothesis& h, const Robot& robot, const core::Odometry& motion) const;
  core::StepReport report(const core::Scan& scan, const Associator& associator, std::size_t heaviest,
                          const Hypothesis& before) const;
  std::size_t node_bytes() const;
};

/// The factor L of a symmetric positive semidefinite matrix, L·Lᵀ.
Eigen::Matrix3d root(const Eigen::Matrix3d& covariance);

/// Weighted mean of poses, headings on the circle, and covariance about it.
class PoseMean {
 public:
  void add(double weight, const Eigen::Vector3d& pose) {
    position_ += weight * pose.head<2>();
    sine_ += weight * std::sin(pose[2]), cosine_ += weight * std::cos(pose[2]);
  }
  core::Pose2 mean() const { return {position_.x(), position_.y(), std::atan2(sine_, cosine_)}; }

 private:
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
  double sine_ = 0.0, cosine_ = 0.0;
};

}  // namespace helixnav::fastslam
