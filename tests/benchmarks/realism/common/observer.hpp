// From a simulated scan and its truth to what the statistics read.
#pragma once

#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/sight.hpp"
#include "tests/benchmarks/realism/common/observed_scan.hpp"

namespace boresight::bench::realism {

class Observer {
 public:
  Observer(const simulator::Scenario& scenario, const VehicleConfig& vehicle);

  /// `event`: a scan that `drive` has just returned.
  [[nodiscard]] ObservedScan observe(const simulator::Drive& drive, const simulator::Event& event);

 private:
  struct Radar {
    RadarConfig config;
    simulator::Sight sight;
  };
  simulator::RadarEffects effects_;
  std::vector<Radar> radars_;
  std::vector<simulator::BodySight> sights_;
};

}  // namespace boresight::bench::realism
