#include <iostream>

#include <helixnav/sim/simulate.hpp>
#include <helixnav/supervisor/navigator.hpp>

int main() {
  using namespace helixnav;
  const core::Recording drive = sim::simulate(sim::named_scenario("large-loop"), /*seed=*/1);
  supervisor::Navigator navigator(drive.start);
  for (const core::Event& event : drive.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) navigator.move(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) navigator.observe(*scan);
  }
  std::cout << navigator.map().size() << " landmarks, robot at " << navigator.pose().mean.vector().transpose() << '\n';
}
