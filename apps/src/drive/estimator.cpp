// SPDX-License-Identifier: BSD-3-Clause
#include "estimator.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "common/chosen_navigator.hpp"
#include "common/joint_map_of.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "helixnav/supervisor/pose_on_map.hpp"
#include "localizer_feed.hpp"
#include "navigator_on_map.hpp"
#include "start_check.hpp"

namespace helixnav::apps {
namespace {

double reach_of_log(const Drive& job) {
  return logs::field_of_view_of(job.recording).reach().value_or(supervisor::reference_reach_m);
}

/// Without searches the filter is not handed over, and closings by restart forget what ties a drive together.
void check_for_one_filter(const Drive& job) {
  const supervisor::SearchOptions& search = job.navigator.search;
  if (search.enabled && search.closing != supervisor::ClosingMethod::restart) return;
  check_has_covariance(job.earlier->map, "--map", "a session without searches, or with restarts,");
}

/// A session that does not know where it is calls its own start the origin.
ChosenNavigator begun(const Drive& job, const std::vector<std::vector<core::Label>>& labels) {
  if (!job.earlier) return {job.recording, job.navigator, job.known_association, labels};
  const EarlierSession& earlier = *job.earlier;
  check_for_one_filter(job);
  if (earlier.start.kind == SessionStart::Kind::unknown) {
    supervisor::Navigator navigator(core::PoseGaussian{}, job.navigator);
    navigator.look_for_place_in(earlier.map);
    return {std::move(navigator), labels};
  }
  const bool at_end = earlier.start.kind == SessionStart::Kind::end;
  const core::JointMap map =
      at_end ? earlier.map
             : supervisor::begun_at(earlier.map, given_start(earlier.start.T_map_robot, reach_of_log(job)));
  if (job.known_association) return {supervisor::NamedNavigator(map, earlier.landmark_of, job.navigator), labels};
  return {supervisor::Navigator::go_on_in(map, job.navigator), labels};
}

/// Of a pose that was given, or of the end of the earlier session; names tell by themselves.
std::optional<StartCheck> check_of_start(const Drive& job) {
  if (!job.earlier || job.earlier->start.kind == SessionStart::Kind::unknown || job.known_association) {
    return std::nullopt;
  }
  const core::JointMap& map = job.earlier->map;
  const bool at_end = job.earlier->start.kind == SessionStart::Kind::end;
  const core::Pose2& T_map_start = at_end ? map.joint.pose : job.earlier->start.T_map_robot;
  return StartCheck(map, T_map_start, reach_of_log(job), job.navigator);
}

bool is_same_map(const core::JointMap& one, const core::JointMap& other) {
  return one.joint.ids == other.joint.ids && one.joint.points_m == other.joint.points_m;
}

/// Part 0 is the earlier map, and stays where that is stored, unless the session has continued in it.
std::map<int, core::JointMap> parts_of(const ChosenNavigator& navigator, const Drive& job) {
  std::map<int, core::JointMap> maps = navigator.maps_apart();
  const auto first = maps.find(0);
  if (!job.earlier || first == maps.end()) return maps;
  first->second.drives = job.earlier->map.drives;
  if (is_same_map(first->second, job.earlier->map)) maps.erase(first);
  return maps;
}

struct NavigatorDrive {
  std::vector<std::vector<core::Label>> labels;
  ChosenNavigator navigator;
  std::optional<StartCheck> check;
  bool is_start_ambiguous = false;
  core::LandmarkId earlier_next_name;

  explicit NavigatorDrive(const Drive& job)
      : labels(labels_fed(job)),
        navigator(begun(job, labels)),
        check(check_of_start(job)),
        earlier_next_name(job.earlier ? job.earlier->map.next_name : 0) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    std::optional<core::StepReport> report = navigator.take(event);
    if (!check) return report;
    const auto believed = [this] { return supervisor::pose_on_map(navigator.filter(), earlier_next_name); };
    check->take(event, report ? &*report : nullptr, believed);
    if (std::optional<StartCheck::RightStart> right = check->right_start()) {
      navigator = ChosenNavigator(std::move(right->navigator), labels);
      report = std::move(right->report);
    }
    is_start_ambiguous = check->is_ambiguous();
    if (check->is_over()) check.reset();
    return report;
  }
};

}  // namespace

std::vector<std::vector<core::Label>> labels_fed(const Drive& job) {
  std::vector<std::vector<core::Label>> labels;
  for (std::size_t k = 0; k < job.recording.labels.size(); ++k) {
    if (job.withheld.empty() || !job.withheld[k]) labels.push_back(job.recording.labels[k]);
  }
  return labels;
}

Estimator navigator_of(const Drive& job) {
  const auto drive = std::make_shared<NavigatorDrive>(job);
  return {[drive](const core::Event& event) { return drive->take(event); },
          [drive] { return drive->navigator.pose(); },
          [drive] { return drive->navigator.map(); },
          [drive, &job] { return joint_map_of(drive->navigator, job.recording); },
          {},
          [drive, &job] { return parts_of(drive->navigator, job); },
          [drive] { return drive->navigator.sketch(); },
          [drive] { return drive->is_start_ambiguous; }};
}

namespace {

template <class Feed>
Estimator on_given_map(std::shared_ptr<Feed> feed, const Drive& job) {
  Estimator estimator;
  estimator.take = [feed](const core::Event& event) { return feed->take(event); };
  estimator.pose = [feed] { return feed->pose(); };
  estimator.map = [&job] { return job.given_map->landmarks; };
  estimator.joint_map = [] { return std::nullopt; };
  return estimator;
}

}  // namespace

Estimator localizer_of(const Drive& job, LabelAgreement& agreement) {
  if (!job.known_association && can_be_searched(*job.given_map)) {
    const auto feed = std::make_shared<NavigatorOnMap>(job, labels_fed(job), agreement);
    Estimator estimator = on_given_map(feed, job);
    estimator.is_start_ambiguous = [feed] { return feed->is_start_ambiguous(); };
    return estimator;
  }
  return on_given_map(std::make_shared<LocalizerFeed>(job, labels_fed(job), agreement), job);
}

Estimator estimator_of(const Drive& job, LabelAgreement& agreement) {
  if (job.given_map) return localizer_of(job, agreement);
  return job.fastslam.chosen ? fastslam_of(job) : navigator_of(job);
}

}  // namespace helixnav::apps
