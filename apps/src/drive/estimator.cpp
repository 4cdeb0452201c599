// SPDX-License-Identifier: BSD-3-Clause
#include "estimator.hpp"

#include <cstddef>
#include <memory>
#include <utility>
#include <variant>

#include "common/chosen_navigator.hpp"
#include "common/joint_map_of.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "localizer_feed.hpp"
#include "navigator_on_map.hpp"

namespace helixnav::apps {
namespace {

/// A session that does not know where it is calls its own start the origin.
ChosenNavigator begun(const Drive& job, const std::vector<std::vector<core::Label>>& labels) {
  if (!job.earlier) return {job.recording, job.navigator, job.known_association, labels};
  const EarlierSession& earlier = *job.earlier;
  if (earlier.start.kind == SessionStart::Kind::unknown) {
    supervisor::Navigator navigator(core::PoseGaussian{}, job.navigator);
    navigator.look_for_place_in(earlier.map);
    return {std::move(navigator), labels};
  }
  const double reach_m = logs::field_of_view_of(job.recording).reach().value_or(supervisor::reference_reach_m);
  const bool at_end = earlier.start.kind == SessionStart::Kind::end;
  const core::JointMap map = at_end ? earlier.map : seen_from(earlier.map, earlier.start.T_map_robot, reach_m);
  if (job.known_association) return {supervisor::NamedNavigator(map, earlier.landmark_of, job.navigator), labels};
  return {supervisor::Navigator::go_on_in(map, job.navigator), labels};
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

  explicit NavigatorDrive(const Drive& job) : labels(labels_fed(job)), navigator(begun(job, labels)) {}
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
  return {[drive](const core::Event& event) { return drive->navigator.take(event); },
          [drive] { return drive->navigator.pose(); },
          [drive] { return drive->navigator.map(); },
          [drive, &job] { return joint_map_of(drive->navigator, job.recording); },
          {},
          [drive, &job] { return parts_of(drive->navigator, job); },
          [drive] { return drive->navigator.sketch(); }};
}

namespace {

template <class Feed>
Estimator on_given_map(std::shared_ptr<Feed> feed, const Drive& job) {
  return {[feed](const core::Event& event) { return feed->take(event); }, [feed] { return feed->pose(); },
          [&job] { return job.given_map->landmarks; }, [] { return std::nullopt; }};
}

}  // namespace

Estimator localizer_of(const Drive& job, LabelAgreement& agreement) {
  if (!job.known_association && can_be_searched(*job.given_map)) {
    return on_given_map(std::make_shared<NavigatorOnMap>(job, labels_fed(job), agreement), job);
  }
  return on_given_map(std::make_shared<LocalizerFeed>(job, labels_fed(job), agreement), job);
}

Estimator estimator_of(const Drive& job, LabelAgreement& agreement) {
  if (job.given_map) return localizer_of(job, agreement);
  return job.fastslam.chosen ? fastslam_of(job) : navigator_of(job);
}

}  // namespace helixnav::apps
