#include "tests/benchmarks/alignment/common/world_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "services/simulator/car/body.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/radar/mounting.hpp"
#include "services/simulator/random.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/runner.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"

namespace boresight::bench {

namespace {

using simulator::Misalignment;

simulator::Scenario scenario_of(const WorldDrive& of) {
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  simulator::use_profile(scenario, of.profile);
  scenario.effects.real_car = of.real_car;
  simulator::Stream stream(of.seed, "bench truth");
  scenario.effects.speed_scale = draw_speed_scale(stream);
  for (Misalignment& radar : scenario.effects.misalignment) {
    radar.yaw_rad = draw_mounting_error(stream);
    radar.pitch_rad = draw_mounting_error(stream);
    radar.roll_rad = draw_mounting_error(stream);
  }
  return scenario;
}

Eigen::Matrix3d nominal_of(const RadarConfig& radar) {
  return geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
}

judge::AlignmentSample sample_of(const alignment::RadarEstimate& estimate, const RadarConfig& radar, double t_s) {
  judge::AlignmentSample sample;
  sample.t_s = t_s;
  sample.radar = radar.id;
  sample.speed_scale = estimate.speed_scale;
  sample.rotation = estimate.sensor_to_vehicle * nominal_of(radar).transpose();
  sample.step_changes = estimate.step_change.count;
  const AlignmentValue& load = estimate.nuisance.load_pitch_rad;
  sample.load_pitch_rad = load.value;
  sample.load_pitch_variance = std::pow(static_cast<double>(load.std), 2);
  for (std::size_t i = 0; i < kParameterBits.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const bool is_observable = (estimate.observable & kParameterBits[i]) != 0;
    sample.variances(place) = is_observable ? estimate.covariance(place, place) : 0.0;
  }
  return sample;
}

judge::MountingTruth truth_of(const simulator::RadarEffects& effects, const RadarConfig& radar, std::uint64_t seed,
                              double t_s) {
  const simulator::car::RealCar& car = effects.real_car;
  judge::MountingTruth truth;
  truth.speed_scale = speed_scale_seen(
      effects.speed_scale, simulator::car::radar_of_car(car, seed, radar.id, radar.field_of_view).range_rate_scale);
  truth.has_rotation = true;
  // The mounting is that on the body. No data tell the load at the start from it; a later load is a state of its own.
  const double load_at_start_rad = simulator::car::load_pitch_rad(car, 0.0);
  truth.load_pitch_rad = simulator::car::load_pitch_rad(car, t_s) - load_at_start_rad;
  truth.rotation = geometry::sensor_to_vehicle(0.0, load_at_start_rad, 0.0) *
                   simulator::radar::actual_mounting(radar.mounting_pose, effects, radar.id, t_s) *
                   nominal_of(radar).transpose();
  truth.step_changes = static_cast<std::uint32_t>(
      std::count_if(effects.step_changes.begin(), effects.step_changes.end(),
                    [&](const simulator::RadarStepChange& c) { return c.radar == radar.id && c.time_s <= t_s; }));
  return truth;
}

/// A scan on its way: radars send it after its stamp, which may be later than the measurement.
struct SentScan {
  double t_s = 0.0;  ///< of the measurement
  std::unique_ptr<RadarScan> scan;
  [[nodiscard]] std::int64_t stamp_ns() const { return scan->header.measurement_time_ns; }
};

}  // namespace

WorldRun run_world_drive(const WorldDrive& of) {
  const simulator::Scenario scenario = scenario_of(of);
  const VehicleConfig vehicle = vehicle_of(scenario);
  WorldRun run;
  run.radars = vehicle.radars.size();
  run.truth.resize(run.radars);
  run.duration_s = std::min(of.duration_s, scenario.duration_s);
  simulator::Drive drive(scenario, vehicle, of.seed, run.duration_s);
  alignment::Estimator estimator(vehicle, {});
  judge::AlignmentJudge judge;
  std::vector<SentScan> sent;  // by stamp
  const auto deliver_before = [&](std::int64_t time_ns) {
    const auto end = std::find_if(sent.begin(), sent.end(), [&](const SentScan& s) { return s.stamp_ns() >= time_ns; });
    for (auto it = sent.begin(); it != end; ++it) {
      if (estimator.add_scan(*it->scan) != alignment::ScanResult::kPublish) continue;
      const RadarConfig& radar = *vehicle.radar(it->scan->header.source_id);
      const auto index = static_cast<std::size_t>(&radar - vehicle.radars.data());
      run.truth[index] = truth_of(scenario.effects, radar, of.seed, it->t_s);
      judge.add(sample_of(estimator.estimate(index), radar, it->t_s), run.truth[index]);
    }
    sent.erase(sent.begin(), end);
  };
  while (const simulator::Event* event = drive.next()) {
    if (event->scan != nullptr) {
      const auto later =
          std::find_if(sent.begin(), sent.end(), [&](const SentScan& s) { return s.stamp_ns() > event->stamp_ns; });
      sent.insert(later, {event->t_s, std::make_unique<RadarScan>(*event->scan)});
      continue;
    }
    deliver_before(event->time_ns);
    estimator.add_ego_motion(simulator::to_message(*event, vehicle.ego));
  }
  deliver_before(std::numeric_limits<std::int64_t>::max());
  judge.write(run.figures);
  return run;
}

}  // namespace boresight::bench
