// SPDX-License-Identifier: BSD-3-Clause
// Closing by replay and by restart.
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "closing/close_by_merge.hpp"
#include "closing/close_by_replay.hpp"
#include "closing/close_by_restart.hpp"
#include "closing/replay_branch.hpp"
#include "full_ekf.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

using cekf::CompressedEkf;
using cekf::Retraction;
using core::LandmarkId;

/// Two laps of a circle among trees: on the second, the trees of the first are taken for new ones, with a tape, while a
/// full EKF that knows better runs alongside. Between the laps is a stretch without scans, so that the error is large.
class TwoLaps {
 public:
  explicit TwoLaps(Retraction retraction, std::uint64_t seed = 5)
      : random_(seed, "replay test"),
        right_invariant_(retraction == Retraction::right_invariant),
        filter(core::PoseGaussian{}, options_of(retraction)) {
    for (int i = 0; i < trees; ++i) {
      const double along = 2.0 * core::pi * i / trees;
      const double out_m = radius_m + (i % 2 == 0 ? 6.0 : -7.0) + random_.uniform(-2.0, 2.0);
      points_m_.emplace_back(out_m * std::sin(along), radius_m - out_m * std::cos(along));
    }
    for (int k = 0; k < scans_a_lap; ++k) step(first_lap_, nullptr);
  }

  /// Goes round once more after a slip of about this size.
  void come_back(int scans, double slip_m = 1.0, double slip_rad = 0.1) {
    core::Odometry blind;
    blind.covariance = Eigen::Vector3d(slip_m * slip_m, slip_m * slip_m, slip_rad * slip_rad).asDiagonal();
    const Eigen::Vector3d slip = random_.normal3(blind.covariance);
    blind.T_before_after = core::Pose2(slip);
    filter.predict(blind);
    twin_.emplace_back(blind);
    trigger.emplace(Checkpoint{filter.snapshot(), association::LandmarkLife(), {}, 0, tape.end()});
    filter.keep_since(trigger->filter.phase);
    for (int k = 0; k < scans; ++k) step(branch_, &tape);
  }

  /// The same events through a full EKF given that a tree of the branch is the tree of the first lap.
  support::FullEkf named_filter(const std::vector<int>& known_again) const;

  std::vector<pf_relocalize::ConstellationPair> pairs(std::size_t most = 100) const {
    std::vector<pf_relocalize::ConstellationPair> result;
    for (const auto& [tree, id] : branch_) {
      if (first_lap_.count(tree) > 0 && result.size() < most) result.push_back({id, first_lap_.at(tree), 0.0});
    }
    return result;
  }
  std::vector<int> known(std::size_t most = 100) const {
    std::vector<int> result;
    for (const auto& [tree, id] : branch_) {
      if (first_lap_.count(tree) > 0 && result.size() < most) result.push_back(tree);
    }
    return result;
  }
  std::vector<LandmarkId> old() const {
    std::vector<LandmarkId> ids;
    for (const auto& [tree, id] : first_lap_) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  Branch branch() const {
    Branch all;
    for (const auto& [tree, id] : branch_) all.confirmed.push_back(id);
    std::sort(all.confirmed.begin(), all.confirmed.end());
    return all;
  }
  /// Largest differences of pose and common landmarks, in mean and covariance.
  double difference_from(const support::FullEkf& twin) const;

 private:
  static constexpr int trees = 40;
  static constexpr int scans_a_lap = 90;
  static constexpr double radius_m = 60.0;
  struct Sight {
    int tree;
    core::Observation z;
    bool branch;
  };
  using Event = std::variant<core::Odometry, std::vector<Sight>>;

  static cekf::FilterOptions options_of(Retraction retraction) {
    cekf::FilterOptions options;
    options.retraction = retraction;
    options.cell_side_m = 20.0;
    options.hysteresis_m = 2.0;
    return options;
  }

  void step(std::map<int, LandmarkId>& ids, Tape* writing) {
    core::Odometry motion;
    const double step_rad = 2.0 * core::pi / scans_a_lap;
    const core::Pose2 truly(radius_m * std::sin(step_rad), radius_m * (1.0 - std::cos(step_rad)), step_rad);
    motion.covariance = Eigen::Vector3d(4e-4, 4e-4, 4e-6).asDiagonal();
    motion.T_before_after = core::Pose2(Eigen::Vector3d(truly.vector() + random_.normal3(motion.covariance)));
    truth_ = core::compose(truth_, truly);
    filter.predict(motion);
    if (writing != nullptr) writing->append(Tape::Motion{motion, 0.0});
    twin_.emplace_back(motion);

    core::Scan scan;
    core::StepReport report;
    std::vector<Sight> sights;
    std::vector<cekf::Match> matched;
    for (int i = 0; i < trees; ++i) {
      const Eigen::Vector2d seen = core::transform(core::inverse(truth_), points_m_[static_cast<std::size_t>(i)]);
      if (seen.norm() > 25.0) continue;
      const core::Observation z =
          core::make_range_bearing(seen.norm() + random_.normal(0.0, 0.1),
                                   std::atan2(seen.y(), seen.x()) + random_.normal(0.0, 0.01), 0.1, 0.01);
      core::AssociationReport a;
      a.observation = static_cast<int>(scan.observations.size());
      a.outcome = ids.count(i) > 0 ? core::Outcome::matched : core::Outcome::augmented;
      if (ids.count(i) > 0) matched.push_back({a.landmark = ids.at(i), z, {}});
      scan.observations.push_back(z);
      report.associations.push_back(a);
      sights.push_back({i, z, writing != nullptr});
    }
    const cekf::UpdateResult result = filter.update(matched);
    report.joint_nis = result.nis;
    report.joint_dof = result.dof;
    for (core::AssociationReport& a : report.associations) {
      if (a.outcome != core::Outcome::augmented) continue;
      a.landmark = filter.augment(scan.observations[static_cast<std::size_t>(a.observation)], {});
      ids[sights[static_cast<std::size_t>(a.observation)].tree] = a.landmark;
    }
    twin_.emplace_back(sights);
    if (writing != nullptr)
      writing->append(Tape::Scan{scan, report.associations, report.joint_nis, report.joint_dof, {}});
    filter.switch_region_if_due();
  }

  core::RandomStream random_;
  bool right_invariant_;
  core::Pose2 truth_;
  std::vector<Eigen::Vector2d> points_m_;
  std::map<int, LandmarkId> first_lap_, branch_;
  std::vector<Event> twin_;

 public:
  CompressedEkf filter;
  Tape tape{0};
  std::optional<Checkpoint> trigger;
  BranchRecord record() const { return {*trigger, tape}; }
};

support::FullEkf TwoLaps::named_filter(const std::vector<int>& known_again) const {
  support::FullEkf ekf(core::PoseGaussian{}, right_invariant_);
  std::set<LandmarkId> mapped;
  for (const Event& event : twin_) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      ekf.predict(*odometry);
      continue;
    }
    std::vector<support::FullEkf::Sighting> matched, born;
    bool again = false;
    for (const Sight& sight : std::get<std::vector<Sight>>(event)) {
      const bool is_known = std::find(known_again.begin(), known_again.end(), sight.tree) != known_again.end();
      const bool as_old = !sight.branch || is_known;
      const LandmarkId id = as_old ? first_lap_.at(sight.tree) : branch_.at(sight.tree);
      again = again || (sight.branch && is_known);
      (mapped.count(id) > 0 ? matched : born).push_back({id, sight.z, {}});
    }
    if (!matched.empty()) again ? ekf.update_iterated(matched) : ekf.update(matched);
    for (const auto& one : born) {
      ekf.augment(one.id, one.observation, one.T_robot_sensor);
      mapped.insert(one.id);
    }
  }
  return ekf;
}

double TwoLaps::difference_from(const support::FullEkf& twin) const {
  const core::JointGaussian joint = filter.joint(twin.ids);
  double largest = (joint.covariance - twin.P).cwiseAbs().maxCoeff();
  largest = std::max(largest, (joint.pose.vector() - twin.x.head<3>()).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < twin.ids.size(); ++i) {
    const Eigen::Vector2d point_m = twin.x.segment<2>(twin.row_of(twin.ids[i]));
    largest = std::max(largest, (joint.points_m[i] - point_m).cwiseAbs().maxCoeff());
  }
  return largest;
}

class Replay : public testing::TestWithParam<Retraction> {};

TEST_P(Replay, EqualsAFullFilterToldTheSameAssociationsAcrossRegionSwitches) {
  TwoLaps drive(GetParam());
  const long phase = drive.filter.phase();
  drive.come_back(40);
  ASSERT_GE(drive.filter.phase(), phase + 2);
  const Closing closing = close_by_replay(drive.filter, drive.record(), drive.pairs(), drive.branch(), drive.old(), {});
  ASSERT_TRUE(closing.accepted);
  EXPECT_EQ(closing.merged.size(), drive.pairs().size());
  EXPECT_EQ(closing.dof, 2 * static_cast<int>(drive.pairs().size()));
  const support::FullEkf twin = drive.named_filter(drive.known());
  ASSERT_EQ(static_cast<std::size_t>(drive.filter.mapped_count()), twin.ids.size());
  EXPECT_LE(drive.difference_from(twin), 1e-7);
}

TEST_P(Replay, FindsTheCopiesThatNobodyNamed) {
  TwoLaps drive(GetParam());
  drive.come_back(40);
  ASSERT_GT(drive.pairs().size(), 8u);
  const Closing closing =
      close_by_replay(drive.filter, drive.record(), drive.pairs(5), drive.branch(), drive.old(), {});
  ASSERT_TRUE(closing.accepted);
  EXPECT_EQ(closing.merged.size(), drive.pairs().size());
  EXPECT_LE(drive.difference_from(drive.named_filter(drive.known())), 1e-7) << "as if all had been named at once";
}

TEST_P(Replay, WithoutAPairIsWhatWasDriven) {
  TwoLaps drive(GetParam());
  drive.come_back(40);
  const cekf::UpdateResult again = replay_branch(drive.filter, drive.record(), {});
  EXPECT_NEAR(again.nis, innovation_cost(drive.tape, 0).nis, 1e-9 * again.nis);
  EXPECT_EQ(again.dof, innovation_cost(drive.tape, 0).dof);
  EXPECT_LE(drive.difference_from(drive.named_filter({})), 1e-7);
}

TEST_P(Replay, CostsWhatMergingCostsAndEndsWhereItDoesWhereErrorsAreSmall) {
  TwoLaps drive(GetParam());
  drive.come_back(40, 0.05, 0.003);
  TwoLaps other = drive;
  SearchOptions options;
  options.merge_sigma_m = 1e-4;
  const Closing replayed =
      close_by_replay(drive.filter, drive.record(), drive.pairs(), drive.branch(), drive.old(), options);
  const Closing merged = close_by_merge(other.filter, other.pairs(), other.branch(), other.old(), options);
  ASSERT_TRUE(merged.accepted);
  EXPECT_NEAR(replayed.cost, merged.cost, 0.01 * merged.cost);
  const core::PoseGaussian a = drive.filter.pose(), b = other.filter.pose();
  EXPECT_LE((a.mean.vector() - b.mean.vector()).norm(), 0.1 * std::sqrt(b.covariance.trace()));
  EXPECT_LE((a.covariance - b.covariance).norm(), 0.01 * b.covariance.norm());
}

TEST_P(Replay, RefusesWhatTheMapCannotBelieveAndLeavesItAsItWas) {
  TwoLaps drive(GetParam());
  drive.come_back(40);
  auto pairs = drive.pairs();
  std::rotate(pairs.begin(), pairs.begin() + 1, pairs.end());
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].old_landmark = drive.pairs()[i].old_landmark;
  const core::PoseGaussian before = drive.filter.pose();
  const Closing closing = close_by_replay(drive.filter, drive.record(), pairs, drive.branch(), drive.old(), {});
  EXPECT_FALSE(closing.accepted);
  EXPECT_TRUE(closing.merged.empty());
  EXPECT_EQ(drive.filter.pose().mean.vector(), before.mean.vector());
  EXPECT_EQ(drive.filter.pose().covariance, before.covariance);
  SearchOptions credulous;
  credulous.closing_probability = 1.0 - 1e-12;  // the choice of pairs accepts what the replay then refuses
  EXPECT_TRUE(
      close_by_replay(drive.filter, drive.record(), drive.pairs(), drive.branch(), drive.old(), credulous).accepted)
      << "and can be asked again";
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Replay, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

TEST(Restart, ForgetsTheBranchAndBelievesTheParticles) {
  TwoLaps drive(Retraction::right_invariant);
  const std::vector<LandmarkId> before = drive.filter.landmarks();
  drive.come_back(40);
  core::PoseGaussian particles;
  particles.mean = core::Pose2(3.0, 4.0, 0.5);
  particles.covariance = Eigen::Vector3d(0.2, 0.1, 0.01).asDiagonal();
  const Closing closing = close_by_restart(drive.filter, drive.branch().confirmed, particles);
  EXPECT_TRUE(closing.accepted);
  EXPECT_EQ(closing.forgotten, drive.branch().confirmed);
  EXPECT_EQ(drive.filter.landmarks(), before);
  EXPECT_EQ(drive.filter.pose().mean.vector(), particles.mean.vector());
  EXPECT_EQ(drive.filter.joint({before.front()}).covariance.topRightCorner(3, 2).norm(), 0.0);
}

NavigatorOptions closing_by(ClosingMethod method) {
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  options.search.closing = method;
  return options;
}

/// Seeds not used in development.
TEST(ClosingMethods, AllCloseALoopWhereTheTruthIs) {
  for (const ClosingMethod method : {ClosingMethod::merge, ClosingMethod::replay, ClosingMethod::restart}) {
    const core::Recording run = sim::simulate(sim::named_scenario("large-loop-changed"), 7001);
    Navigator navigator(run.start, closing_by(method));
    int closures = 0;
    drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
      const core::StepReport report = navigator.observe(scan);
      for (const core::Decision& decision : report.decisions) {
        const auto* closure = std::get_if<core::ClosureDecision>(&decision);
        if (closure == nullptr || !closure->accepted) continue;
        ++closures;
        const Eigen::Vector2d truth_m = run.true_poses[i].T_world_robot.position_m();
        EXPECT_LT((report.pose.mean.position_m() - truth_m).norm(), 2.0);
        EXPECT_EQ(report.merged.empty(), method == ClosingMethod::restart);
      }
    });
    EXPECT_GE(closures, 1);
    EXPECT_EQ(navigator.filter().phases_kept(), 1) << "what was kept for going back is let go";
  }
}

TEST(ClosingMethods, ThePapersRuleAsksNoConstellation) {
  const core::Recording run = sim::simulate(sim::named_scenario("sparse"), 7001);
  NavigatorOptions options = closing_by(ClosingMethod::restart);
  options.search.acceptance = Acceptance::paper_rule;
  Navigator navigator(run.start, options);
  int accepted = 0, questions = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) {
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      accepted += closure != nullptr && closure->accepted ? 1 : 0;
      questions += std::holds_alternative<core::VerificationDecision>(decision) ? 1 : 0;
    }
  });
  EXPECT_GE(accepted, 1);
  EXPECT_EQ(questions, 0);
}

}  // namespace
}  // namespace helixnav::supervisor
