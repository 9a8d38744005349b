#include "tests/benchmarks/realism/common/drives.hpp"

#include <algorithm>
#include <memory>

#include "services/simulator/drive.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/realism/common/observer.hpp"

namespace boresight::bench::realism {

namespace {

void add_drive(const std::string& name, const std::string& profile, const VehicleConfig& vehicle, std::uint64_t seed,
               double longest_s, Statistics& statistics) {
  const simulator::Scenario scenario = with_profile(simulator::scenario(name), profile);
  simulator::Drive drive(scenario, vehicle, seed, std::min(longest_s, scenario.duration_s));
  Observer observer(scenario, vehicle);
  while (const simulator::Event* event = drive.next()) {
    if (event->scan != nullptr) statistics.add(observer.observe(drive, *event));
  }
  statistics.end_drive();
}

}  // namespace

Statistics simulate(const Drives& drives, const std::string& profile, const VehicleConfig& demo) {
  const Source source = source_of(profile);
  const VehicleConfig vehicle = measuring_vehicle(demo, source);
  const Counting counting = source == Source::kNuScenes ? Counting::kInSight : Counting::kFirstToLast;
  const std::size_t count = drives.scenarios.size();
  std::vector<std::unique_ptr<Statistics>> parts(count);
  parallel_for(count, drives.jobs, [&](std::size_t i) {
    parts[i] = std::make_unique<Statistics>();
    add_drive(drives.scenarios[i], profile, vehicle, drives.seed, drives.longest_s, *parts[i]);
  });
  Statistics all;
  all.counting = counting;
  for (auto& part : parts) {
    all.merge(*part);
    part.reset();
  }
  return all;
}

}  // namespace boresight::bench::realism
