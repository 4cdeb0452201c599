// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/navigator.hpp"

#include <utility>
#include <variant>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

Navigator::Navigator(const core::PoseGaussian& start, const NavigatorOptions& options) {
  core::check_start(start);
  loop_ = std::make_unique<NavigationLoop>(start, options);
}

Navigator::Navigator(std::unique_ptr<NavigationLoop> loop) : loop_(std::move(loop)) {}

Navigator Navigator::go_on_in(const core::JointMap& earlier, const NavigatorOptions& options) {
  check_has_end(earlier);
  return Navigator(std::make_unique<NavigationLoop>(earlier, options));
}

Navigator::~Navigator() = default;
Navigator::Navigator(Navigator&&) noexcept = default;
Navigator& Navigator::operator=(Navigator&&) noexcept = default;

std::optional<core::StepReport> Navigator::take(const core::Event& event) {
  if (const auto* scan = std::get_if<core::Scan>(&event)) return observe(*scan);
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) move(*odometry);
  if (const auto* absolute = std::get_if<core::AbsoluteFix>(&event)) fix(*absolute);
  if (const auto* lost = std::get_if<core::Lost>(&event)) lose(*lost);
  return std::nullopt;
}

void Navigator::move(const core::Odometry& odometry) {
  core::check(odometry);
  loop_->move(odometry);
}

core::StepReport Navigator::observe(const core::Scan& scan) {
  core::check(scan);
  return loop_->observe(scan);
}

bool Navigator::fix(const core::AbsoluteFix& fix) {
  core::check(fix);
  return loop_->fix(fix);
}

void Navigator::lose(const core::Lost& lost) { loop_->lose(lost); }

std::map<int, core::JointMap> Navigator::maps_apart() const {
  std::map<int, core::JointMap> maps;
  for (const MapApart& apart : loop_->maps_apart().maps) maps.emplace(apart.part, *apart.map);
  return maps;
}

void Navigator::look_for_place_in(const core::JointMap& earlier) { loop_->look_for_place_in(earlier); }

core::PoseGaussian Navigator::pose() const { return loop_->pose(); }
const cekf::CompressedEkf& Navigator::filter() const { return loop_->belief().filter; }

core::JointGaussian Navigator::joint(const std::vector<core::LandmarkId>& ids) const { return loop_->joint(ids); }

std::optional<core::JointMap> Navigator::factored_map(FactoredMap how) const { return loop_->factored(sketch(), how); }

std::vector<core::MapLandmark> Navigator::sketch() const {
  const Belief& belief = loop_->belief();
  const std::vector<core::LandmarkId> ids = loop_->landmarks();
  const std::vector<core::PointGaussian> points = loop_->sketched(ids);
  std::vector<core::MapLandmark> landmarks(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    core::MapLandmark& landmark = landmarks[i];
    landmark.id = ids[i];
    landmark.point = points[i];
    landmark.observations = belief.existence.record(ids[i]).observations;
    landmark.state = belief.existence.state(ids[i]);
    landmark.appearance = belief.existence.appearance().of(ids[i]);
  }
  return landmarks;
}

std::vector<core::MapLandmark> Navigator::map() const {
  std::vector<core::MapLandmark> landmarks = sketch();
  if (static_cast<int>(landmarks.size()) == filter().mapped_count()) return landmarks;
  try {
    const std::vector<core::PointGaussian> points = loop_->marginals();
    for (std::size_t i = 0; i < landmarks.size(); ++i) landmarks[i].point = points[i];
  } catch (const core::NumericalError&) {
    return sketch();  // what is torn is not solved: as it was solved last
  }
  return landmarks;
}

}  // namespace helixnav::supervisor
