#include "services/boresight/commands/alignment_drive_options.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight {

namespace {

const std::map<std::string, simulator::RoadKind>& roads() {
  static const std::map<std::string, simulator::RoadKind> kRoads{{"city", simulator::RoadKind::kCity},
                                                                 {"mixed", simulator::RoadKind::kMixed},
                                                                 {"motorway", simulator::RoadKind::kMotorway},
                                                                 {"slow", simulator::RoadKind::kSlow},
                                                                 {"straight", simulator::RoadKind::kStraight}};
  return kRoads;
}

std::size_t index_of(const simulator::AlignmentSpec& spec, std::uint32_t id) {
  for (std::size_t i = 0; i < spec.radars.size(); ++i) {
    if (spec.radars[i].config.id == id) return i;
  }
  throw std::invalid_argument("the vehicle has no radar " + std::to_string(id));
}

simulator::StepChange parse_step_change(const std::string& text, const simulator::AlignmentSpec& spec) {
  double time_s = 0.0;
  unsigned id = 0;
  std::array<double, 3> turn_deg{};
  int end = 0;
  const int read = std::sscanf(text.c_str(), "%lf,%u,%lf,%lf,%lf%n", &time_s, &id, turn_deg.data(), &turn_deg[1],
                               &turn_deg[2], &end);
  if (read != 5 || static_cast<std::size_t>(end) != text.size()) {
    throw std::invalid_argument("--step-change " + text + ": must be SECONDS,RADAR,X,Y,Z with the rotation in degrees");
  }
  return {simulator::AlignmentDrive::kStart_s + time_s, index_of(spec, id),
          Eigen::Vector3d(turn_deg[0], turn_deg[1], turn_deg[2]) * kRadiansPerDegree};
}

}  // namespace

CLI::Option* add_alignment_drive_options(CLI::App& command, AlignmentDriveOptions& options) {
  CLI::App* const group =
      command.add_option_group("Alignment drive", "Writes tables for `boresight align` instead of recordings");
  CLI::Option* const road =
      group->add_option("--alignment-drive", options.road, "Statistical drive with known truth on this kind of road")
          ->check(CLI::IsMember(roads()));
  const auto number = [&](const char* name, double& value, const char* text, double low, double high) {
    group->add_option(name, value, text)->check(CLI::Range(low, high))->capture_default_str()->needs(road);
  };
  const auto flag = [&](const char* name, bool& value, const char* text) {
    group->add_flag(name, value, text)->needs(road);
  };
  flag("--planar", options.planar, "The truth follows Burza's planar roll model instead of rotations");
  flag("--random-truth", options.random_truth, "Speed scale and mounting errors (within 3 deg) are drawn by the seed");
  number("--outliers", options.outlier_share, "Share of detections that are not stationary", 0.0, 0.95);
  number("--detections", options.mean_detections, "Mean number of detections in a scan", 1.0, 500.0);
  number("--noise-scale", options.noise_scale, "Factor from the angle noise of the vehicle file to the simulated one",
         0.0, 20.0);
  flag("--stds", options.states_stds, "Radars report the standard deviations of their detections");
  flag("--unsynchronised", options.unsynchronised, "Each radar measures at its own times");
  number("--ambiguity", options.ambiguity_mps, "Width of the unambiguous range-rate interval, m/s; 0: no ambiguity",
         0.0, 1000.0);
  group
      ->add_option("--no-elevation", options.without_elevation,
                   "Ids of radars that measure no elevation, separated by commas")
      ->delimiter(',')
      ->needs(road);
  number("--yaw-rate-bias", options.yaw_rate_bias_degps, "Bias of the yaw-rate signal, deg/s", -10.0, 10.0);
  number("--slip", options.slip_coefficient, "Rear slip angle per lateral acceleration, rad per m/s2", -0.05, 0.05);
  number("--body-pitch", options.body_pitch_deg, "Standard deviation of the body's pitch, deg", 0.0, 5.0);
  number("--brake-pitch", options.brake_pitch_deg, "Nose-down pitch per deceleration, deg per m/s2", -2.0, 2.0);
  group
      ->add_option("--step-change", options.step_changes,
                   "SECONDS,RADAR,X,Y,Z: sudden misalignment (step change) of a radar, a rotation in deg about the "
                   "vehicle's axes; repeatable")
      ->delimiter(';')
      ->needs(road);
  return road;
}

simulator::AlignmentSpec alignment_spec(const AlignmentDriveOptions& options, const VehicleConfig* vehicle,
                                        std::uint64_t seed, double duration_s) {
  simulator::AlignmentSpec spec = vehicle != nullptr ? simulator::radars_of(*vehicle) : simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = duration_s;
  spec.road = roads().at(options.road);
  if (options.planar) spec.model = simulator::MountingModel::kPlanar;
  spec.outlier_share = options.outlier_share;
  spec.yaw_rate_bias_radps = options.yaw_rate_bias_degps * kRadiansPerDegree;
  spec.slip_coefficient_radps2pm = options.slip_coefficient;
  spec.body_pitch_std_rad = options.body_pitch_deg * kRadiansPerDegree;
  spec.body_pitch_per_acceleration_radps2pm = options.brake_pitch_deg * kRadiansPerDegree;
  if (options.random_truth) simulator::draw_truth(spec);
  for (std::size_t i = 0; i < spec.radars.size(); ++i) {
    simulator::AlignmentRadar& radar = spec.radars[i];
    radar.states_stds = options.states_stds;
    radar.mean_detections = options.mean_detections;
    radar.noise_scale = options.noise_scale;
    radar.ambiguity_mps = options.ambiguity_mps;
    // In whole tenths of a millisecond, which is what the tables resolve.
    if (options.unsynchronised) radar.first_scan_s = 0.0101 * static_cast<double>(i + 1);
  }
  for (const std::uint32_t id : options.without_elevation) spec.radars[index_of(spec, id)].measures_elevation = false;
  for (const std::string& step_change : options.step_changes)
    spec.step_changes.push_back(parse_step_change(step_change, spec));
  return spec;
}

}  // namespace boresight
