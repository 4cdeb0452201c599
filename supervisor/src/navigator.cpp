// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/navigator.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "ambiguous_return.hpp"
#include "association_report.hpp"
#include "branch_journal.hpp"
#include "candidates.hpp"
#include "drive_log.hpp"
#include "gating.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "history.hpp"
#include "missing_spawn.hpp"
#include "probation.hpp"
#include "search.hpp"
#include "track.hpp"

namespace helixnav::supervisor {

using core::AssociationReport;
using core::LandmarkId;
using core::Outcome;
using core::Scan;
using core::StepReport;

Navigator::Navigator(const core::PoseGaussian& start, const NavigatorOptions& options)
    : options_(options),
      filter_(start, options.filter),
      life_(options.life),
      track_(std::make_unique<Track>(options.search.coverage_spacing_m)),
      drive_(std::make_unique<DriveLog>(start, options.search.enabled ? options.search.smooth_up_to_scans : 0)),
      probation_(std::make_unique<Probation>()),
      doubts_(std::make_unique<MissingSpawn>()),
      history_(std::make_unique<History>()),
      delayed_(options.delayed) {}

Navigator::~Navigator() = default;
Navigator::Navigator(Navigator&&) noexcept = default;
Navigator& Navigator::operator=(Navigator&&) noexcept = default;

void Navigator::move(const core::Odometry& odometry) {
  motion_ = motion_ ? core::chain(*motion_, odometry) : odometry;
  driven_m_ += odometry.T_before_after.position_m().norm();
}

/// Before the first landmark; what was predicted and fixed until then is in the pose.
void Navigator::fit_to(const core::FieldOfView& view) {
  if (fitted_ || !view.reach()) return;
  fitted_ = true;
  view_ = view;
  if (!options_.fit_lengths) return;
  const cekf::FilterOptions before = options_.filter;
  options_ = fit_lengths(options_, view);
  const bool new_cells =
      before.cell_side_m != options_.filter.cell_side_m || before.hysteresis_m != options_.filter.hysteresis_m;
  if (new_cells && step_ == 0) filter_ = cekf::CompressedEkf(filter_.pose(), options_.filter);
  life_.set_lengths(options_.life.look_distance_m, options_.life.tentative_patience_m);
  track_->set_spacing(options_.search.coverage_spacing_m);
  delayed_.set_lengths(options_.delayed);
}

StepReport Navigator::observe(const Scan& scan) {
  fit_to(scan.field_of_view);
  StepReport report = navigate(scan);
  keep_in_mind(scan, report);
  return has_got_lost() ? search_from_before(std::move(report)) : report;
}

StepReport Navigator::navigate(const Scan& scan) {
  predict();
  StepReport report;
  std::optional<Gating> gating;
  gating.emplace(filter_, candidates_of(scan), scan, options_.gates);
  std::vector<AmbiguousReturn> returns = old_ones_in_gate(scan, *gating);
  if (is_lost(returns, report)) {
    begin_search();
    gating.emplace(filter_, candidates_of(scan), scan, options_.gates);
    returns.clear();
  }
  report.associations = associate(scan, *gating, returns);
  update(scan, report);
  augment(scan, report);
  if (journal_) journal_->observe(scan, report);
  drive_->observe(scan, report);
  live_and_let_die(scan, report);
  if (search_) pursue_search(scan, report);
  report.switched_region = filter_.switch_region_if_due();
  return close_step(scan, report);
}

StepReport Navigator::observe(const Scan& scan, const std::vector<std::int64_t>& identities) {
  StepReport report;
  report.associations = known_associations(scan, identities);
  fit_to(scan.field_of_view);
  if (search_) end_search();  // it asked for what is known now
  drive_->let_go();
  if (!history_->empty()) history_->clear(filter_);
  predict();
  update(scan, report);
  augment_known(scan, identities, report);
  remember(identities, report);
  report.switched_region = filter_.switch_region_if_due();
  return close_step(scan, report);
}

bool Navigator::fix(const core::AbsoluteFix& fix) {
  predict();
  const double nis = filter_.position_innovation(fix).nis;
  const double limit = core::chi2_quantile(options_.fix_probability, 2);
  const bool accepted = nis <= limit;
  if (accepted) filter_.update_position(fix);
  if (accepted && journal_) journal_->fix(fix);
  if (accepted) drive_->fix(fix, nis);
  if (!search_) history_->note(fix);
  const core::PoseGaussian now = filter_.pose();
  decisions_.push_back({"fix",
                        accepted ? "accepted" : "refused",
                        {{"nis", nis},
                         {"gate", limit},
                         {"x_m", fix.position_world_m.x()},
                         {"y_m", fix.position_world_m.y()},
                         {"pose_sigma_m", std::sqrt(now.covariance.topLeftCorner<2, 2>().trace())}}});
  return accepted;
}

void Navigator::predict() {
  if (!motion_) return;
  filter_.predict(*motion_);
  if (search_) search_->move(*motion_);
  if (journal_) journal_->predict(*motion_);
  drive_->predict(*motion_);
  if (!search_) history_->note(History::Motion{*motion_, driven_m_});
  life_.drive(driven_m_);
  driven_m_ = 0.0;
  motion_.reset();
}

std::vector<LandmarkId> Navigator::candidates_of(const Scan& scan) const {
  std::vector<LandmarkId> ids = candidates(filter_, scan, options_.candidate_sigmas);
  if (search_) {
    ids.erase(std::remove_if(ids.begin(), ids.end(), [&](LandmarkId id) { return search_->excludes(id); }), ids.end());
  }
  return ids;
}

std::vector<AmbiguousReturn> Navigator::old_ones_in_gate(const Scan& scan, const Gating& gating) const {
  if (!options_.search.enabled || search_) return {};
  return returns_in_gate(filter_, gating.problem, scan, old_landmarks(life_, options_.search.old_after_m),
                         with_foreign(options_.search, life_.born_per_scan(), view_).foreign_per_scan);
}

bool Navigator::is_lost(const std::vector<AmbiguousReturn>& returns, StepReport& report) const {
  const AmbiguousReturn* worst = most_ambiguous(returns);
  if (worst == nullptr || worst->foreign_objects <= options_.search.foreign_objects) return false;
  const core::PoseGaussian now = filter_.pose();
  report.decisions.push_back({"trigger",
                              "started",
                              {{"landmark", worst->landmark},
                               {"foreign_objects", worst->foreign_objects},
                               {"neighbours", worst->neighbours},
                               {"gate_area", worst->gate_area},
                               {"pose_sigma_m", std::sqrt(now.covariance.topLeftCorner<2, 2>().trace())},
                               {"heading_sigma_deg", std::sqrt(now.covariance(2, 2)) * 180.0 / core::pi},
                               {"old_in_gate", static_cast<double>(returns.size())}}});
  return true;
}

std::vector<AssociationReport> Navigator::associate(const Scan& scan, const Gating& gating,
                                                    const std::vector<AmbiguousReturn>& returns) {
  association::Options how = options_.association;
  if (std::isfinite(scan.field_of_view.max_range_m)) {
    how.extraneous = association::uniform_density(scan.field_of_view, options_.extraneous_per_scan);
  }
  std::vector<AssociationReport> reports =
      association_reports(association::associate(options_.method, gating.problem, how));
  hold_lonely_returns(returns, reports);
  return reports;
}

/// Two old landmarks that fit together vouch for one another; one alone, with room for others in its gate, waits, and so
/// does one that would tell the vehicle much about where it is, until it is met again.
void Navigator::hold_lonely_returns(const std::vector<AmbiguousReturn>& returns,
                                    std::vector<AssociationReport>& reports) {
  AssociationReport* lonely = nullptr;
  for (AssociationReport& report : reports) {
    const bool old = std::any_of(returns.begin(), returns.end(),
                                 [&](const AmbiguousReturn& r) { return r.landmark == report.landmark; });
    if (!old || report.outcome != Outcome::matched) continue;
    if (lonely != nullptr) return;
    lonely = &report;
  }
  if (lonely == nullptr) return;
  const auto met = std::find_if(returns.begin(), returns.end(),
                                [&](const AmbiguousReturn& r) { return r.landmark == lonely->landmark; });
  const bool ambiguous = met->foreign_objects > options_.search.hold_objects;
  const bool telling = met->widening > options_.search.probation_widening;
  const bool met_again = probation_->passes(lonely->landmark, life_.path_m(), options_.search.probation_m);
  if (ambiguous || (telling && !met_again)) lonely->outcome = Outcome::ambiguous;
}

std::vector<AssociationReport> Navigator::known_associations(const Scan& scan,
                                                             const std::vector<std::int64_t>& identities) const {
  if (identities.size() != scan.observations.size()) {
    throw core::PreconditionError("observe: " + std::to_string(identities.size()) + " identities for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  std::vector<AssociationReport> reports(identities.size());
  std::set<std::int64_t> born;
  for (std::size_t i = 0; i < identities.size(); ++i) {
    reports[i].observation = static_cast<int>(i);
    const auto known = landmark_of_identity_.find(identities[i]);
    if (identities[i] < 0) {
      reports[i].outcome = Outcome::rejected;
    } else if (known == landmark_of_identity_.end()) {
      const bool first = born.insert(identities[i]).second;
      reports[i].outcome = first ? Outcome::augmented : Outcome::rejected;
    } else {
      reports[i].outcome = Outcome::matched;
      reports[i].landmark = known->second;
    }
  }
  return reports;
}

void Navigator::update(const Scan& scan, StepReport& report) {
  const std::vector<cekf::Match> matched = matches(scan, report.associations);
  if (matched.empty()) return;
  const cekf::UpdateResult result = filter_.update(matched);
  report.joint_nis = result.nis;
  report.joint_dof = result.dof;
}

void Navigator::augment(const Scan& scan, StepReport& report) {
  for (AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const core::Observation& observation = scan.observations[static_cast<std::size_t>(association.observation)];
    if (core::dimension(observation.kind) == 1) {
      association.outcome = Outcome::ambiguous;  // without a name nobody can gather its sightings
      continue;
    }
    association.landmark = filter_.augment(observation, scan.T_robot_sensor);
  }
}

void Navigator::augment_known(const Scan& scan, const std::vector<std::int64_t>& identities, StepReport& report) {
  for (AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const auto index = static_cast<std::size_t>(association.observation);
    const core::Observation& observation = scan.observations[index];
    if (core::dimension(observation.kind) == 2) {
      association.landmark = filter_.augment(observation, scan.T_robot_sensor);
      continue;
    }
    const auto entered = delayed_.sight(filter_, identities[index], observation, scan.T_robot_sensor);
    if (entered) {
      association.landmark = *entered;
    } else {
      association.outcome = Outcome::ambiguous;
    }
  }
}

void Navigator::live_and_let_die(const Scan& scan, StepReport& report) {
  const std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, report.associations);
  const std::vector<LandmarkId> born = landmarks_with(Outcome::augmented, report.associations);
  std::vector<LandmarkId> expected = expected_in_view(filter_, scan, options_.view_margin_m);
  for (const Outcome no_miss : {Outcome::ambiguous, Outcome::rejected, Outcome::augmented}) {
    for (const LandmarkId id : landmarks_with(no_miss, report.associations)) {
      expected.erase(std::remove(expected.begin(), expected.end(), id), expected.end());
    }
  }
  if (!search_) doubts_->observe(life_, expected, seen, options_.search.old_after_m);
  forgive_what_may_be_elsewhere(seen, expected);
  const core::Pose2 T_world_sensor = core::compose(filter_.pose().mean, scan.T_robot_sensor);
  const association::LifeChanges changes = life_.observe(T_world_sensor.position_m(), seen, born, expected);
  for (const LandmarkId id : changes.died) {
    filter_.remove(id);
    if (journal_) journal_->remove(id);
  }
  track_->pass(life_.path_m(), T_world_sensor);
}

/// A scan that recognises nothing old does not know where the old landmarks are, and their absence proves nothing.
void Navigator::forgive_what_may_be_elsewhere(const std::vector<LandmarkId>& seen,
                                              std::vector<LandmarkId>& expected) const {
  const double old_before_m = life_.path_m() - options_.search.old_after_m;
  const auto recognised = std::count_if(seen.begin(), seen.end(),
                                        [&](LandmarkId id) { return life_.record(id).born_path_m < old_before_m; });
  constexpr int enough = 2;
  const auto may_be_elsewhere = [&](LandmarkId id) {
    if (search_ && search_->excludes(id)) return true;
    return recognised < enough && life_.record(id).last_seen_path_m < old_before_m;
  };
  expected.erase(std::remove_if(expected.begin(), expected.end(), may_be_elsewhere), expected.end());
}

void Navigator::remember(const std::vector<std::int64_t>& identities, const StepReport& report) {
  for (const AssociationReport& association : report.associations) {
    const std::int64_t identity = identities[static_cast<std::size_t>(association.observation)];
    if (association.outcome == Outcome::augmented) landmark_of_identity_[identity] = association.landmark;
    if (association.landmark != core::no_landmark) ++observations_of_known_[association.landmark];
  }
}

StepReport Navigator::close_step(const Scan& scan, StepReport report) {
  report.step = step_++;
  report.t_ns = scan.t_ns;
  report.pose = filter_.pose();
  report.active_landmarks = filter_.active_count();
  report.mapped_landmarks = filter_.mapped_count() - delayed_.clones();
  report.decisions.insert(report.decisions.begin(), decisions_.begin(), decisions_.end());
  decisions_.clear();
  return report;
}

std::vector<core::MapLandmark> Navigator::map() const {
  std::vector<core::MapLandmark> landmarks;
  for (const LandmarkId id : filter_.landmarks()) {
    if (delayed_.is_clone(id)) continue;
    core::MapLandmark landmark;
    landmark.id = id;
    landmark.point = filter_.landmark(id);
    const auto known = observations_of_known_.find(id);
    if (known != observations_of_known_.end()) {
      landmark.observations = known->second;
      landmark.state = core::LandmarkState::mature;
    } else if (life_.contains(id)) {
      landmark.observations = life_.record(id).observations;
      landmark.state = life_.state(id);
    }
    landmarks.push_back(landmark);
  }
  return landmarks;
}

}  // namespace helixnav::supervisor
