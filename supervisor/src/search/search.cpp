// SPDX-License-Identifier: BSD-3-Clause
#include "search/search.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/core/odometry.hpp"
#include "search/constellation_question.hpp"

namespace helixnav::supervisor {
namespace {

using pf_relocalize::ConstellationPair;
using pf_relocalize::SearchOutcome;

constexpr std::size_t most_cloud_points = 300;

core::Pose2 base_frame_now(const cekf::CompressedEkf& filter, core::LandmarkId a, core::LandmarkId b) {
  const Eigen::Vector2d a_m = filter.landmark_mean(a);
  const Eigen::Vector2d axis = filter.landmark_mean(b) - a_m;
  return {a_m.x(), a_m.y(), std::atan2(axis.y(), axis.x())};
}

/// Two passed tests agree when no landmark has changed its partner.
bool agree(const std::vector<ConstellationPair>& before, const std::vector<ConstellationPair>& now) {
  return std::none_of(now.begin(), now.end(), [&](const ConstellationPair& n) {
    return std::any_of(before.begin(), before.end(), [&](const ConstellationPair& b) {
      return (b.branch == n.branch) != (b.old_landmark == n.old_landmark);
    });
  });
}

std::ptrdiff_t count_shared(const std::vector<ConstellationPair>& one, const std::vector<ConstellationPair>& other) {
  return std::count_if(one.begin(), one.end(), [&](const ConstellationPair& a) {
    return std::any_of(other.begin(), other.end(), [&](const ConstellationPair& b) {
      return a.branch == b.branch && a.old_landmark == b.old_landmark;
    });
  });
}

/// The winner's pairs and those of the rivals that it is not told apart from; at another place, most are others.
std::vector<std::vector<ConstellationPair>> contested_by(const pf_relocalize::ConstellationVerdict& verdict) {
  std::vector<std::vector<ConstellationPair>> places;
  if (verdict.contesting.empty()) return places;
  places.push_back(verdict.winner.pairs);
  for (const pf_relocalize::ConstellationScore& rival : verdict.contesting) {
    const bool is_known = std::any_of(places.begin(), places.end(), [&](const auto& place) {
      return 2 * count_shared(place, rival.pairs) > static_cast<std::ptrdiff_t>(rival.pairs.size());
    });
    if (!is_known) places.push_back(rival.pairs);
  }
  return places;
}

/// T_world_robot of every n-th particle.
std::vector<core::Pose2> thinned_out(const pf_relocalize::Particles& particles, const core::Pose2& T_world_base) {
  std::vector<core::Pose2> poses;
  const std::size_t stride = std::max<std::size_t>(1, particles.size() / most_cloud_points);
  for (std::size_t i = 0; i < particles.size(); i += stride) {
    poses.push_back(core::compose(T_world_base, particles.pose(i)));
  }
  return poses;
}

}  // namespace

Search::Search(std::vector<core::LandmarkId> old, double path_m, std::uint64_t seed, const SearchOptions& options)
    : options_(options),
      old_(std::move(old)),
      begun_path_m_(path_m),
      seed_(seed),
      motion_(core::no_motion(0)),
      last_look_path_m_(path_m - options.look_distance_m) {}

bool Search::excludes(core::LandmarkId id) const { return std::binary_search(old_.begin(), old_.end(), id); }

void Search::move(const core::Odometry& odometry) { motion_ = core::chain(motion_, odometry); }

std::optional<std::vector<ConstellationPair>> Search::look(const SearchView& view,
                                                           std::vector<core::Decision>& decisions) {
  has_just_started_ = false;
  contested_.clear();
  const double path_m = view.life.path_m();
  const bool has_frame =
      !attempt_ || (view.filter.contains(attempt_->base_a) && view.filter.contains(attempt_->base_b));
  if (!has_frame) end_attempt(Reason::abandoned, path_m, decisions);  // a landmark that carries it has died
  if (path_m - last_look_path_m_ < options_.look_distance_m) return std::nullopt;
  if (!sees_enough(view.scan)) blind_m_ += path_m - last_look_path_m_;
  last_look_path_m_ = path_m;
  const core::Odometry motion = std::exchange(motion_, core::no_motion(view.scan.t_ns));
  if (!attempt_) {
    if (is_promising(view) && path_m >= next_start_path_m_) start(view, decisions);
    return std::nullopt;
  }
  last_in_gate_m_ = seeing_m(path_m);
  attempt_->relocalizer.step(motion, view.scan);
  if (options_.acceptance == Acceptance::paper_rule &&
      pf_relocalize::meets_paper_rule(attempt_->relocalizer.state(), motion)) {
    return std::vector<ConstellationPair>{};
  }
  switch (judge_search(attempt_->relocalizer.state(), options_.gate, options_.give_up)) {
    case SearchOutcome::gate_met:
      if (options_.acceptance == Acceptance::constellation) return question(view, decisions);
      break;
    case SearchOutcome::timed_out:
      end_attempt(Reason::timed_out, path_m, decisions);
      break;
    case SearchOutcome::nothing_here:
      end_attempt(Reason::nothing_here, path_m, decisions);
      break;
    default:
      break;
  }
  return std::nullopt;
}

bool Search::sees_enough(const core::Scan& scan) const {
  return static_cast<int>(scan.observations.size()) >= options_.start_observations;
}

double Search::seeing_m(double path_m) const { return path_m - begun_path_m_ - blind_m_; }

bool Search::is_over(double path_m) const { return seeing_m(path_m) > options_.undecided_m; }

bool Search::is_undecided(double path_m) const {
  const bool idle = !attempt_ && seeing_m(path_m) - last_in_gate_m_ > options_.idle_m;
  return idle || is_over(path_m);
}

void Search::wait(double path_m) { last_in_gate_m_ = seeing_m(path_m) - options_.idle_m + options_.ask_again_m; }

bool Search::is_promising(const SearchView& view) {
  if (!sees_enough(view.scan)) return false;
  // One landmark at a time: the marginal with the pose is all that a gate needs, and two in a gate are enough to know.
  std::vector<bool> in_gate(view.scan.observations.size(), false);
  int count = 0;
  for (const core::LandmarkId id : reference_landmarks(view, old_, 0.0)) {
    const core::JointGaussian joint = view.filter.joint({id});
    const association::InnovationProblem problem = association::make_innovation_problem(joint, view.scan);
    for (std::size_t i = 0; i < in_gate.size(); ++i) {
      if (in_gate[i] || problem.observations[i].nearest_nis >= options_.start_gate) continue;
      in_gate[i] = true;
      ++count;
    }
    if (count >= options_.start_in_gate) break;
  }
  if (count > 0) last_in_gate_m_ = seeing_m(view.life.path_m());
  return count >= options_.start_in_gate;
}

void Search::start(const SearchView& view, std::vector<core::Decision>& decisions) {
  const core::JointGaussian joint = reference_ground(view, old_, options_.reach_m);
  if (joint.ids.size() < 3) return;
  pf_relocalize::ReferenceMapResult reference = pf_relocalize::try_reference_map(joint, options_.reference);
  const double path_m = view.life.path_m();
  ++starts_;
  if (!reference.map) {
    decisions.emplace_back(
        core::ReferenceUnusable{starts_, static_cast<int>(joint.ids.size()), reference.least_eigenvalue});
    next_start_path_m_ = path_m + options_.rest_m;
    return;
  }
  pf_relocalize::ReferenceMap& map = *reference.map;
  const core::LandmarkId a = joint.ids[static_cast<std::size_t>(map.bases.a)];
  const core::LandmarkId b = joint.ids[static_cast<std::size_t>(map.bases.b)];
  const std::uint64_t seed = seed_ + 1000u * static_cast<std::uint64_t>(starts_);
  attempt_.emplace(Attempt{
      pf_relocalize::Relocalizer(std::move(map), view.scan, options_.relocalizer, seed), a, b, path_m, path_m, {}, 0});
  has_just_started_ = true;
  decisions.emplace_back(core::AttemptStarted{starts_, static_cast<int>(joint.ids.size()),
                                              static_cast<int>(attempt_->relocalizer.helix_pairs()),
                                              attempt_->relocalizer.state().log_evidence});
}

std::optional<std::vector<ConstellationPair>> Search::question(const SearchView& view,
                                                               std::vector<core::Decision>& decisions) {
  Attempt& attempt = *attempt_;
  const double path_m = view.life.path_m();
  if (path_m < attempt.next_question_path_m) return std::nullopt;
  if (path_m - attempt.begun_path_m > options_.attempt_m) {
    end_attempt(Reason::abandoned, path_m, decisions);
    return std::nullopt;
  }
  const core::Pose2 T_world_base = base_frame_now(view.filter, attempt.base_a, attempt.base_b);
  const core::Pose2 T_base_robot = attempt.relocalizer.state().modes.front().pose.mean;
  ++questions_;
  const ConstellationAnswer answer =
      ask_constellation(view, old_, begun_path_m_, core::compose(T_world_base, T_base_robot), options_,
                        seed_ + static_cast<std::uint64_t>(questions_));
  decisions.emplace_back(verification_decision(answer));
  contested_ = contested_by(answer.verdict);
  contested_looks_ += contested_.empty() ? 0 : 1;
  const bool accepted = answer.verdict.accepted;
  attempt.passes = !accepted ? 0 : agree(attempt.passed, answer.verdict.winner.pairs) ? attempt.passes + 1 : 1;
  attempt.passed = accepted ? answer.verdict.winner.pairs : std::vector<ConstellationPair>{};
  attempt.next_question_path_m = path_m + (accepted ? options_.confirm_m : options_.ask_again_m);
  if (answer.verdict.rival.matched > answer.verdict.winner.matched && answer.verdict.rival_share > 1.0) {
    end_attempt(Reason::outdone, path_m, decisions);
    next_start_path_m_ = path_m;
    return std::nullopt;
  }
  if (attempt.passes < options_.passes) return std::nullopt;
  return attempt.passed;
}

bool Search::pass(const std::vector<ConstellationPair>& pairs) {
  decided_passes_ = agree(decided_, pairs) ? decided_passes_ + 1 : 1;
  decided_ = pairs;
  return decided_passes_ >= options_.passes;
}

void Search::end_attempt(Reason reason, double path_m, std::vector<core::Decision>& decisions) {
  const pf_relocalize::CloudState& state = attempt_->relocalizer.state();
  decisions.emplace_back(core::AttemptEnded{reason, starts_, state.scans, state.log_evidence, state.modes.front().mass,
                                            path_m - attempt_->begun_path_m});
  refuse(path_m);
}

void Search::refuse(double path_m) {
  attempt_.reset();
  next_start_path_m_ = path_m + options_.rest_m;
}

std::optional<core::PoseGaussian> Search::heaviest_mode(const cekf::CompressedEkf& filter) const {
  if (!attempt_) return std::nullopt;
  const core::Pose2 T_world_base = base_frame_now(filter, attempt_->base_a, attempt_->base_b);
  const core::PoseGaussian& in_base = attempt_->relocalizer.state().modes.front().pose;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(T_world_base.heading_rad).toRotationMatrix();
  return core::PoseGaussian{core::compose(T_world_base, in_base.mean), turn * in_base.covariance * turn.transpose()};
}

std::vector<core::Pose2> Search::cloud(const cekf::CompressedEkf& filter) const {
  if (!attempt_) return {};
  return thinned_out(attempt_->relocalizer.particles(), base_frame_now(filter, attempt_->base_a, attempt_->base_b));
}

std::vector<core::Pose2> Search::drawn(const cekf::CompressedEkf& filter) const {
  if (!attempt_ || !has_just_started_) return {};
  return thinned_out(attempt_->relocalizer.weighted_particles(),
                     base_frame_now(filter, attempt_->base_a, attempt_->base_b));
}

}  // namespace helixnav::supervisor
