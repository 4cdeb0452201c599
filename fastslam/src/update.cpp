// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/resampling.hpp"
#include "impl.hpp"

namespace helixnav::fastslam {

Eigen::Matrix3d root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// A landmark begun beyond this would make every later weight NaN.
void refuse_out_of_bounds(const PreparedScan& scan) {
  for (const PreparedObservation& z : scan.observations) {
    if (z.point_robot_m.norm() < Lineages::farthest_m) continue;
    throw core::NumericalError("fastslam: an observation beyond what a map can hold");
  }
}

/// As core::normalise, but if all weights vanish or are undefined, they are equal from now on: a scan that fits no particle
/// says nothing about which is better. How badly it fits is for NIS to say. Individual undefined weights vanish.
double normalise_or_equal(std::vector<double>& log_weight) {
  for (double& lw : log_weight) {
    if (!std::isfinite(lw)) lw = -HUGE_VAL;
  }
  const auto is_finite = [](double lw) { return std::isfinite(lw); };
  if (std::any_of(log_weight.begin(), log_weight.end(), is_finite)) return core::normalise(log_weight);
  std::fill(log_weight.begin(), log_weight.end(), -std::log(static_cast<double>(log_weight.size())));
  return -HUGE_VAL;
}

core::StepReport FastSlam::Impl::update(const core::Scan& scan, const std::vector<KnownName>* names,
                                        std::size_t robot) {
  const core::RandomStream random_before = random;
  const PreparedScan prepared = prepare(scan);
  const core::Odometry motion = motion_of(robots[robot], scan.t_ns);
  refuse_out_of_bounds(prepared);
  const Associator associator(options, prepared, lineages, maps);
  try {
    propose(robots[robot], motion, scan.observations.size());
    associate(associator, names != nullptr ? known_choices(*names) : std::vector<Choice>{});
    weigh(robot);
  } catch (const core::NumericalError&) {
    random = random_before;
    throw;
  }
  const auto heaviest =
      static_cast<std::size_t>(std::max_element(set_log_weight.begin(), set_log_weight.end()) - set_log_weight.begin());
  const Hypothesis before = before_scan(set.all[heaviest], robots[robot], motion);
  core::StepReport out = report(scan, associator, heaviest, before);
  count_repeated(associator, heaviest, before, robots[robot]);

  drive(robots[robot], motion, scan.T_robot_sensor);
  choose(!scan.observations.empty());
  const std::vector<LineageId> births = begin_lineages(prepared, names);
  draw_poses();
  take_over_maps();
  realise(MapUpdate(options, prepared, lineages, births, robots[robot].look));
  take_over_particles(robot);
  best = static_cast<std::size_t>(std::lower_bound(chosen.begin(), chosen.end(), heaviest) - chosen.begin());
  if (best >= chosen.size()) best = chosen.size() - 1;
  settle();

  for (core::AssociationReport& a : out.associations) {
    if (a.outcome == core::Outcome::augmented)
      a.landmark = static_cast<core::LandmarkId>(births[static_cast<std::size_t>(a.observation)]);
  }
  out.pose = robots[robot].mean;
  out.mapped_landmarks = static_cast<int>(maps[best].size());
  out.particles = cloud;
  ++step;
  return out;
}

core::Odometry FastSlam::Impl::motion_of(const Robot& robot, core::Nanoseconds t_ns) const {
  core::Odometry motion = robot.motion.value_or(core::no_motion(t_ns));
  const double position_m2 = options.added_sigma_m * options.added_sigma_m;
  motion.covariance.diagonal() +=
      Eigen::Vector3d(position_m2, position_m2, options.added_sigma_rad * options.added_sigma_rad);
  return motion;
}

void FastSlam::Impl::propose(const Robot& robot, const core::Odometry& motion, std::size_t observations) {
  const std::size_t m = maps.size();
  const bool draws = options.proposal == Proposal::motion;
  const Eigen::Matrix3d L = root(motion.covariance);
  normals.resize(m);
  if (draws) {
    for (Eigen::Vector3d& n : normals) n << random.normal(), random.normal(), random.normal();
  }
  uniforms.resize(options.association == Association::sampled ? m * observations : 0);
  for (double& u : uniforms) u = random.uniform();
  set.observations = observations;
  set.all.resize(m);
  set.choices.assign(m * observations, of_nothing);
  for_blocks(m, [&](Worker&, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& h = set.all[i];
      h.parent = static_cast<std::uint32_t>(i);
      h.log_weight = log_weight[i];
      if (!draws) {
        h = before_scan(h, robot, motion);
        continue;
      }
      const core::Pose2 moved(motion.T_before_after.vector() + L * normals[i]);
      h.x = core::compose(robot.poses[i], moved).vector();
      h.pose = TurnedPose(h.x);
      h.P.setZero();
    }
  });
}

/// The hypothesis with its pose as odometry has it: with FastSLAM 1.0 the scan does not change it.
Hypothesis FastSlam::Impl::before_scan(const Hypothesis& h, const Robot& robot, const core::Odometry& motion) const {
  Hypothesis before = h;
  if (options.proposal == Proposal::motion) return before;
  const core::Pose2& pose = robot.poses[h.parent];
  before.x = core::compose(pose, motion.T_before_after).vector();
  before.pose = TurnedPose(before.x);
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = core::rotation(pose.heading_rad);
  before.P = J * motion.covariance * J.transpose();
  return before;
}

std::vector<Choice> FastSlam::Impl::known_choices(const std::vector<KnownName>& names) const {
  std::vector<Choice> choices;
  for (const KnownName name : names) {
    const auto heard = named.find(name);
    const Choice unheard = name == no_name ? of_nothing : begins_landmark;
    choices.push_back(heard == named.end() ? unheard : static_cast<Choice>(heard->second));
  }
  return choices;
}

void FastSlam::Impl::associate(const Associator& associator, const std::vector<Choice>& known) {
  const bool several = options.association == Association::multiple_hypotheses;
  for_blocks(set.size(), [&](Worker& worker, std::size_t begin, std::size_t end) {
    associator.look_around(set, begin, end, worker.association);
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& h = set.all[i];
      associator.weigh_view(h, worker.association);
      if (options.association == Association::known) {
        associator.associate_known(h, set.choices_of(i), known);
      } else if (options.association == Association::sampled) {
        associator.associate_sampled(h, set.choices_of(i), uniforms.data() + i * set.observations, worker.association);
      } else if (!several) {
        associator.associate_best_first(h, set.choices_of(i), worker.association);
      }
    }
  });
  if (several) split(associator);
}

void FastSlam::Impl::split(const Associator& associator) {
  for (std::size_t j = 0; j < set.observations; ++j) {
    append_children(associator, j);
    if (set.size() > options.hypotheses.most_children * options.particles) prune();
  }
}

void FastSlam::Impl::append_children(const Associator& associator, std::size_t observation) {
  for (Worker& worker : workers) {
    worker.association.children.clear();
    worker.association.children.observations = set.observations;
  }
  for_blocks(set.size(), [&](Worker& worker, std::size_t begin, std::size_t end) {
    associator.look_around(set, begin, end, observation, worker.association);
    for (std::size_t i = begin; i < end; ++i) {
      associator.split(set.all[i], set.choices_of(i), observation, worker.association);
    }
  });
  // Workers hold successive slices: in their order the children are in the order of their parents.
  set.clear();
  for (const Worker& worker : workers) {
    const HypothesisSet& children = worker.association.children;
    set.all.insert(set.all.end(), children.all.begin(), children.all.end());
    set.choices.insert(set.choices.end(), children.choices.begin(), children.choices.end());
  }
}

void FastSlam::Impl::prune() {
  set_log_weight.clear();
  for (const Hypothesis& h : set.all) set_log_weight.push_back(h.log_weight);
  const double log_sum = normalise_or_equal(set_log_weight);
  core::systematic_parents(set_log_weight, options.particles, random.uniform(), chosen);
  HypothesisSet kept;
  kept.observations = set.observations;
  for (const std::uint32_t k : chosen) {
    kept.append(set.all[k], set.choices_of(k));
    kept.all.back().log_weight = log_sum - std::log(static_cast<double>(options.particles));
  }
  std::swap(set, kept);
}

void FastSlam::Impl::count_repeated(const Associator& associator, std::size_t heaviest, const Hypothesis& before,
                                    Robot& robot) {
  innovations.clear();
  for (std::size_t j = 0; j < set.observations; ++j) {
    const Choice choice = set.choices_of(heaviest)[j];
    if (choice < 0) continue;
    const auto id = static_cast<LineageId>(choice);
    const Eigen::Vector2d innovation = associator.normalised_innovation(before, id, j);
    if (innovation.allFinite()) innovations.emplace_back(id, innovation);
  }
  if (!innovations.empty()) robot.repeated.count(innovations);
}

/// Weights tell particles apart by what the scan itself has to say. Using all of it, if consecutive scans repeat each
/// other, picks the ancestor of all particles long before a loop can tell which was right. Children of several hypotheses,
/// which differ in what a scan says about one landmark or two, are weighted as they are.
void FastSlam::Impl::weigh(std::size_t robot) {
  const bool several = options.association == Association::multiple_hypotheses;
  const double own_share = several ? 1.0 : robots[robot].repeated.own_share();
  for (Hypothesis& h : set.all) {
    const double before = log_weight[h.parent];
    h.log_weight = before + own_share * (h.log_weight - before);
  }
  set_log_weight.clear();
  for (const Hypothesis& h : set.all) set_log_weight.push_back(h.log_weight);
  const double log_sum = normalise_or_equal(set_log_weight);
  cloud.hypotheses = set.size();
  cloud.log_evidence = log_sum;
  cloud.effective_size = core::effective_sample_size(set_log_weight);
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const auto pose_of = [&](std::size_t i) {
      return r == robot ? set.all[i].x : robots[r].poses[set.all[i].parent].vector();
    };
    PoseMean sum;
    for (std::size_t i = 0; i < set.size(); ++i) sum.add(std::exp(set_log_weight[i]), pose_of(i));
    core::PoseGaussian& mean = robots[r].mean;
    mean = {sum.mean(), Eigen::Matrix3d::Zero()};
    for (std::size_t i = 0; i < set.size(); ++i) {
      Eigen::Vector3d d = pose_of(i) - mean.mean.vector();
      d[2] = core::wrap_to_pi(d[2]);
      const double w = std::exp(set_log_weight[i]);
      mean.covariance += w * d * d.transpose();
      if (r == robot) mean.covariance += w * set.all[i].P;
    }
  }
}

}  // namespace helixnav::fastslam
