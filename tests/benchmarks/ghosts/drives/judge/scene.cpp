#include "tests/benchmarks/ghosts/drives/judge/scene.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"
#include "tests/closed_loop/chain.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

MedianFigure median_figure(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return {median(values), median_interval(values)};
}

}  // namespace

Limits cell_limits(Provenance truth, Provenance label, double published_percent) {
  if (truth == label) return at_least(published_percent);
  // The corrector decides which detections are stationary, not the filter: nobody can be below 0.
  if (published_percent == 0.0) return {};
  return at_most(published_percent);
}

judge::Confusion run_scene(std::uint64_t seed, double longest_s, const ghosts::Config& config) {
  simulator::Scenario scenario = simulator::scenario("highway_multipath");
  simulator::use_profile(scenario, "ideal");
  const VehicleConfig vehicle = vehicle_of(scenario);
  constexpr double kScene_s = 11.4;  // 114 steps of 0.1 s
  simulator::Drive drive(scenario, vehicle, seed, std::min({longest_s, kScene_s, scenario.duration_s}));
  closed_loop::Front front(vehicle);
  closed_loop::Back back(vehicle, ghosts::make_method(config));
  judge::Confusion confusion;
  while (const simulator::Event* event = drive.next()) {
    if (!front.take(*event)) continue;
    back.take(*front.corrected);
    const ClassifiedScan& scan = *back.classified;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      confusion.add((*event->truth)[i].provenance, scan.provenance[i],
                    (scan.detection_flags[i] & corrected_flag::kRejected) != 0);
    }
  }
  return confusion;
}

MedianFigure percent_of_cell(const std::vector<judge::Confusion>& drives, Provenance truth, Provenance label) {
  std::vector<double> values;
  for (const judge::Confusion& drive : drives) values.push_back(drive.percent(truth, label));
  return median_figure(std::move(values));
}

MedianFigure count_of(const std::vector<judge::Confusion>& drives, Provenance truth) {
  std::vector<double> values;
  for (const judge::Confusion& drive : drives) {
    values.push_back(static_cast<double>(drive.count(truth) + drive.rejected(truth)));
  }
  return median_figure(std::move(values));
}

}  // namespace boresight::bench::ghosts_drives
