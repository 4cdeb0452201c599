#include <iostream>

#include <helixnav/sim/simulate.hpp>
#include <helixnav/supervisor/navigator.hpp>

int main() {
  using namespace helixnav;
  const core::Recording drive = sim::simulate(sim::named_scenario("large-loop"), /*seed=*/1);
  supervisor::Navigator navigator(drive.start);
  for (const core::Event& event : drive.events) navigator.take(event);
  std::cout << navigator.map().size() << " landmarks, robot at " << navigator.pose().mean.vector().transpose() << '\n';
}
