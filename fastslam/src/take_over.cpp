// SPDX-License-Identifier: BSD-3-Clause
//
// Second half of a scan: from weighted hypotheses to the next particles.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include "helixnav/core/resampling.hpp"
#include "impl.hpp"

namespace helixnav::fastslam {
namespace {

/// L·Lᵀ = covariance, lower triangular; a direction without variance gives a column of zeros.
Eigen::Matrix3d lower_factor(const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double pivot = covariance(j, j) - L.row(j).head(j).squaredNorm();
    if (!(pivot > 1e-14 * covariance(j, j))) continue;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i) {
      L(i, j) = (covariance(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
    }
  }
  return L;
}

}  // namespace

FastSlam::Impl::Impl(const std::vector<core::PoseGaussian>& starts, const Options& chosen_options, std::uint64_t seed)
    : options(chosen_options),
      random(seed, "fastslam"),
      threads(chosen_options.threads),
      robots(starts.size()),
      log_weight(chosen_options.particles, -std::log(static_cast<double>(chosen_options.particles))),
      maps(chosen_options.particles),
      genealogy(chosen_options.particles, chosen_options.genealogy_m) {
  for (unsigned k = 0; k < options.threads; ++k) workers.emplace_back(options.threads == 1);
  for (std::size_t r = 0; r < robots.size(); ++r) {
    robots[r].mean = starts[r];
    for (std::size_t i = 0; i < options.particles; ++i) {
      const Eigen::Vector3d drawn = starts[r].mean.vector() + random.normal3(starts[r].covariance);
      robots[r].poses.emplace_back(drawn);
    }
  }
}

FastSlam::Impl::~Impl() = default;  // nodes go with their pools

void FastSlam::Impl::begin_with(const std::vector<core::PointGaussian>& landmarks) {
  NodePool& pool = workers.front().pool;
  for (const core::PointGaussian& given : landmarks) {
    const LineageId id = lineages.add(given.mean_m);
    const Eigen::Vector2d offset_m = given.mean_m - lineages.anchor_m(id);
    LandmarkRecord& landmark = maps.front().write(id, pool);
    landmark = {};
    landmark.dx_m = static_cast<float>(offset_m.x()), landmark.dy_m = static_cast<float>(offset_m.y());
    landmark.set_covariance_m2({given.covariance_m2(0, 0), given.covariance_m2(0, 1), given.covariance_m2(1, 1)});
    landmark.log_odds = static_cast<float>(options.existence.max_log_odds);
    landmark.hits = static_cast<std::uint16_t>(options.existence.mature_looks);
    landmark.mature = 1;
    lineages.grow(id, Lineages::reach_for(offset_m.norm() + search_reach_m(options, landmark)));
  }
  swept_at = lineages.size();
  for (std::size_t i = 1; i < maps.size(); ++i) maps[i].share(maps.front(), pool);
}

/// Looks are counted by how far the sensor has moved, so that nothing is counted twice while it stands still.
void FastSlam::Impl::drive(Robot& robot, const core::Odometry& motion, const core::Pose2& T_robot_sensor) {
  robot.motion.reset();
  robot.T_look_robot = core::compose(robot.T_look_robot, motion.T_before_after);
  const Eigen::Vector2d sensor_m = T_robot_sensor.position_m();
  const double come_m = (core::transform(robot.T_look_robot, sensor_m) - sensor_m).norm();
  if (!robot.has_looked || come_m >= options.existence.look_distance_m) {
    robot.T_look_robot = core::Pose2();
    robot.look = ++looks;
    robot.has_looked = true;
  }
  genealogy.drive(motion.T_before_after.position_m().norm(), maps.size());
}

void FastSlam::Impl::choose(bool sees) {
  const std::size_t m = options.particles;
  if (options.association == Association::multiple_hypotheses) {
    scans_since_resampling += sees ? 1 : 0;
    cloud.resampled = set.size() > options.hypotheses.most_children * m ||
                      (sees && scans_since_resampling >= options.hypotheses.resample_every_scans);
  } else {
    cloud.resampled = cloud.effective_size < options.resample_below * static_cast<double>(m);
  }
  if (cloud.resampled) {
    scans_since_resampling = 0;
    core::systematic_parents(set_log_weight, m, random.uniform(), chosen);
    log_weight.assign(m, -std::log(static_cast<double>(m)));
  } else {
    chosen.resize(set.size());
    std::iota(chosen.begin(), chosen.end(), 0U);
    log_weight = set_log_weight;
  }
  parents.resize(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) parents[k] = set.all[chosen[k]].parent;
}

std::vector<LineageId> FastSlam::Impl::begin_lineages(const PreparedScan& scan, const std::vector<KnownName>* names) {
  std::vector<LineageId> births(set.observations, 0);
  for (std::size_t j = 0; j < set.observations; ++j) {
    const auto known = names != nullptr ? named.find((*names)[j]) : named.end();
    if (known != named.end()) {
      births[j] = known->second;
      continue;
    }
    const auto bears = [&](std::uint32_t h) { return set.choices_of(h)[j] == begins_landmark; };
    const auto first = std::find_if(chosen.begin(), chosen.end(), bears);
    if (first == chosen.end()) continue;
    births[j] = lineages.add(set.all[*first].pose.place(scan.observations[j].point_robot_m));
    if (names == nullptr) continue;
    named[(*names)[j]] = births[j];
    names_of_lineages[births[j]] = (*names)[j];
  }
  return births;
}

/// A child has its parent's copy of the hypothesis to itself, unless the pose was drawn before the scan. With FastSLAM
/// 2.0 the weight does not depend on the pose drawn, so that every child may draw its own after resampling.
bool FastSlam::Impl::repeats(std::size_t k) const {
  return options.proposal == Proposal::motion && k > 0 && chosen[k] == chosen[k - 1];
}

void FastSlam::Impl::draw_poses() {
  new_poses.resize(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Hypothesis& h = set.all[chosen[k]];
    new_poses[k] = h.x;
    if (options.proposal == Proposal::motion) continue;
    Eigen::Vector3d n;
    n << random.normal(), random.normal(), random.normal();
    new_poses[k] += lower_factor(h.P) * n;
  }
}

/// Every particle that is not a repetition gets its parent's map: the last one the map itself, earlier ones copies.
void FastSlam::Impl::take_over_maps() {
  NodePool& pool = workers.front().pool;
  new_maps.resize(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (repeats(k)) continue;
    std::size_t next = k + 1;
    while (next < chosen.size() && repeats(next)) ++next;
    if (next < chosen.size() && parents[next] == parents[k]) {
      new_maps[k].share(maps[parents[k]], pool);
    } else {
      new_maps[k] = std::move(maps[parents[k]]);
    }
  }
  for_blocks(maps.size(), [&](Worker& worker, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) maps[i].clear(worker.pool);
  });
}

void FastSlam::Impl::realise(const MapUpdate& map_update) {
  for_blocks(chosen.size(), [&](Worker& worker, std::size_t begin, std::size_t end) {
    map_update.look_around(new_poses, begin, end, worker.realise);
    for (std::size_t k = begin; k < end; ++k) {
      if (repeats(k)) continue;
      map_update.apply(new_poses[k], set.choices_of(chosen[k]), new_maps[k], worker.pool, worker.realise);
    }
  });
  for (std::size_t k = 1; k < chosen.size(); ++k) {
    if (repeats(k)) new_maps[k].share(new_maps[k - 1], workers.front().pool);
  }
  for (Worker& worker : workers) {
    for (const auto& [id, reach_m] : worker.realise.growth) lineages.grow(id, reach_m);
    worker.realise.growth.clear();
  }
}

void FastSlam::Impl::take_over_particles(std::size_t robot) {
  for (std::size_t r = 0; r < robots.size(); ++r) {
    std::vector<core::Pose2> poses(chosen.size());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      poses[k] = r == robot ? core::Pose2(new_poses[k]) : robots[r].poses[parents[k]];
    }
    robots[r].poses = std::move(poses);
  }
  std::swap(maps, new_maps);
  new_maps.clear();
  genealogy.descend(parents);
  cloud.distinct_ancestors = genealogy.distinct_ancestors();
}

void FastSlam::Impl::settle() {
  most_node_bytes = std::max(most_node_bytes, node_bytes());
  for (std::size_t k = 1; k < workers.size(); ++k) workers[k].pool.balance(workers[k - 1].pool);
  if (lineages.size() - swept_at > lineages.living() / 2 + 256) sweep_lineages();
}

/// Forgets lineages that no particle holds. Those with a name stay: they may be seen again.
void FastSlam::Impl::sweep_lineages() {
  std::vector<bool> alive(lineages.size(), false);
  for (const auto& [id, name] : names_of_lineages) alive[id] = true;
  std::unordered_set<const void*> visited;
  for (const PersistentMap& map : maps) {
    map.for_each_leaf([&](const void* at) { return !visited.insert(at).second; },
                      [&](LineageId first, const MapLeaf& leaf) {
                        for (std::uint32_t k = 0; k < 8; ++k) {
                          if ((leaf.present >> k & 1U) != 0) alive[first + k] = true;
                        }
                      });
  }
  lineages.sweep(alive);
  swept_at = lineages.size();
}

}  // namespace helixnav::fastslam
