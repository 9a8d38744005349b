// A small scenario for the tests.
#pragma once

#include "tests/benchmarks/tracking/scenarios/common/made_scenario.hpp"

namespace boresight::bench::scenarios::testing {

/// Two cars that drive side by side, 40 m apart, for 200 scans; hardly any clutter.
inline Scenario two_cars() {
  Scenario scenario = make_scenario(1, 20, 1, 1);
  scenario.name = "two cars";
  scenario.model.clutter_per_scan = 5.0;
  scenario.detections_per_scan = {{1, 6.0}, {2, 10.0}};
  scenario.truth.assign(200, {});
  for (std::size_t i = 0; i < scenario.truth.size(); ++i) {
    for (const std::uint32_t id : {1U, 2U}) {
      const double x_m = -50.0 + 0.5 * static_cast<double>(i), y_m = id == 1 ? -20.0 : 20.0;
      scenario.truth[i].push_back({judge::ellipse_in_box({x_m, y_m}, 0.0, 4.6, 1.8), {5.0, 0.0}, id});
    }
  }
  return scenario;
}

}  // namespace boresight::bench::scenarios::testing
