// Drives for the search for wrong inputs.
#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/car/real_car.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/random.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/unit/alignment_estimator/plausibility/wrong_inputs.hpp"

namespace boresight::alignment::plausibility {

/// Four corner radars of a real car, each angle wrong by up to `mounting_error_deg`.
inline simulator::AlignmentSpec drive_of_real_car(simulator::RoadKind road, double duration_s, std::uint64_t seed,
                                                  double mounting_error_deg = 2.0) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.road = road;
  spec.duration_s = duration_s;
  spec.seed = seed;
  spec.real_car = simulator::car::real_car_preset();
  simulator::Stream stream(seed, "plausibility test");
  for (simulator::AlignmentRadar& radar : spec.radars) {
    const double limit_rad = mounting_error_deg * kRadiansPerDegree;
    radar.truth = {stream.uniform(-limit_rad, limit_rad), stream.uniform(-2.0, 2.0) * kRadiansPerDegree,
                   stream.uniform(-2.0, 2.0) * kRadiansPerDegree};
  }
  return spec;
}

/// One radar that looks straight ahead.
inline simulator::AlignmentSpec front_radar_only(simulator::AlignmentSpec spec) {
  spec.radars.resize(1);
  spec.radars[0].config.mounting_pose.position_m = {3.8, 0.0, 0.5};
  spec.radars[0].config.mounting_pose.yaw_rad = 0.0;
  return spec;
}

inline void play(simulator::AlignmentDrive& drive, Bench& bench, double until_s = 1e9) {
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    if (event.ego != nullptr) bench.add(*event.ego, event.time_s);
    if (event.scan != nullptr) bench.add(event.radar, *event.scan, event.time_s);
    if (event.time_s >= until_s) return;
  }
}

inline std::unique_ptr<Bench> play(const simulator::AlignmentSpec& spec, Wrong wrong) {
  simulator::AlignmentDrive drive(spec);
  auto bench = std::make_unique<Bench>(drive.vehicle(), wrong);
  play(drive, *bench);
  return bench;
}

/// A drive of the world simulator; scans arrive in the order of their stamps.
inline std::unique_ptr<Bench> play_world(const std::string& name, const std::string& profile, std::uint64_t seed,
                                         double duration_s, Wrong wrong) {
  simulator::Scenario scenario = simulator::scenario(name);
  simulator::use_profile(scenario, profile);
  scenario.effects.real_car = simulator::car::real_car_preset();
  const std::string vehicle_name = scenario.vehicle.empty() ? "demo" : scenario.vehicle;
  const VehicleConfig vehicle = config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) /
                                                          "config/vehicle" / (vehicle_name + ".toml"));
  simulator::Drive drive(scenario, vehicle, seed, std::min(duration_s, scenario.duration_s));
  auto bench = std::make_unique<Bench>(vehicle, wrong);
  std::multimap<std::int64_t, std::unique_ptr<RadarScan>> sent;
  const auto deliver_before = [&](std::int64_t time_ns) {
    while (!sent.empty() && sent.begin()->first < time_ns) {
      const RadarScan& scan = *sent.begin()->second;
      const auto radar = static_cast<std::size_t>(vehicle.radar(scan.header.source_id) - vehicle.radars.data());
      bench->add(radar, scan,
                 1e-9 * static_cast<double>(scan.header.measurement_time_ns - simulator::Drive::kStart_ns));
      sent.erase(sent.begin());
    }
  };
  while (const simulator::Event* event = drive.next()) {
    if (event->scan != nullptr) {
      sent.emplace(event->stamp_ns, std::make_unique<RadarScan>(*event->scan));
      continue;
    }
    deliver_before(event->time_ns);
    bench->add(simulator::to_message(*event, vehicle.ego), event->t_s);
  }
  deliver_before(std::numeric_limits<std::int64_t>::max());
  return bench;
}

}  // namespace boresight::alignment::plausibility
