#include "tests/benchmarks/alignment/common/real_car_drives.hpp"

#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/real_car.hpp"
#include "services/simulator/random.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

using simulator::AlignmentSpec;
using simulator::RoadKind;
using simulator::Stream;

namespace {

double draw_size(const AlignmentSpec& spec, double low, double high) {
  return Stream(spec.seed, "bench effect size").uniform(low, high);
}

double draw_sign(std::uint64_t seed) {
  return Stream(seed, "bench effect sign").uniform() < 0.5 ? -1.0 : 1.0;
}

/// As disturbed_drive().
void add_body_pitch(AlignmentSpec& spec) {
  spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  spec.body_pitch_per_acceleration_radps2pm = 0.2 * kRadiansPerDegree;
}

void add_real_car(AlignmentSpec& spec) {
  spec.real_car = simulator::car::real_car_preset();
  spec.real_car.load_pitch_rad = 0.0;
  add_body_pitch(spec);
}

void add_load(AlignmentSpec& spec, double size_rad) {
  spec.real_car.load_pitch_rad = draw_sign(spec.seed) * size_rad;
  spec.real_car.load_time_s = draw_change_s(spec.seed);
}

}  // namespace

AlignmentSpec real_car_drive(RoadKind road, double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(road, duration_s, seed);
  add_real_car(spec);
  return spec;
}

RoadKind road_in_turn(std::size_t drive) {
  constexpr RoadKind kRoads[kRoadsInTurn] = {RoadKind::kMixed, RoadKind::kCity, RoadKind::kMotorway};
  return kRoads[drive % kRoadsInTurn];
}

double draw_change_s(std::uint64_t seed) {
  return Stream(seed, "bench change time").uniform(60.0, 120.0);
}

const std::vector<RealCarKind>& real_car_kinds() {
  using simulator::car::real_car_preset;
  static const std::vector<RealCarKind> kinds = {
      {"range-rate scales 0.25 %",
       [](AlignmentSpec& s) { s.real_car.range_rate_scale = real_car_preset().range_rate_scale; }},
      {"azimuth curve 0.1–0.4°",
       [](AlignmentSpec& s) { s.real_car.azimuth_curve_rms_rad = draw_size(s, 0.1, 0.4) * kRadiansPerDegree; }},
      {"position 2–10 cm", [](AlignmentSpec& s) { s.real_car.position_error_m = draw_size(s, 0.02, 0.10); }},
      {"late stamps 10–80 ms", [](AlignmentSpec& s) { s.real_car.stamp_offset_s = draw_size(s, 0.01, 0.08); }},
      // Its own bar is NEES alone: side slip looks like yaw.
      {"crosswind 0.06–0.15°",
       [](AlignmentSpec& s) { s.real_car.side_slip_std_rad = draw_size(s, 0.06, 0.15) * kRadiansPerDegree; }, false,
       false, false},
      {"slip 0.003–0.006 rad/(m/s²)",
       [](AlignmentSpec& s) { s.real_car.slip_coefficient_radps2pm = draw_size(s, 0.003, 0.006); }},
      {"load 0.3–0.8°", [](AlignmentSpec& s) { add_load(s, draw_size(s, 0.3, 0.8) * kRadiansPerDegree); }},
      {"road mirror 5–10 %", [](AlignmentSpec& s) { s.real_car.road_mirror_share = draw_size(s, 0.05, 0.10); }},
      {"road mirror 15 %", [](AlignmentSpec& s) { s.real_car.road_mirror_share = 0.15; }, false, false},
      {"yaw-rate gain ±1 %", [](AlignmentSpec& s) { s.real_car.yaw_rate_gain = 0.01 * draw_sign(s.seed); }},
      {"yaw-rate bias ±0.1°/s",
       [](AlignmentSpec& s) { s.real_car.yaw_rate_bias_radps = 0.1 * kRadiansPerDegree * draw_sign(s.seed); }},
      {"speed in steps of 0.1 km/h",
       [](AlignmentSpec& s) { s.real_car.speed_step_mps = real_car_preset().speed_step_mps; }},
      {"body pitch 0.3°", add_body_pitch},
      {"real_car", add_real_car, true},
      {"real_car and load 0.5°",
       [](AlignmentSpec& s) {
         add_real_car(s);
         add_load(s, real_car_preset().load_pitch_rad);
       }},
  };
  return kinds;
}

std::vector<AlignmentSpec> drives_of(const RealCarKind& kind, std::size_t drives, double duration_s,
                                     std::uint64_t first_seed) {
  std::vector<AlignmentSpec> specs;
  for (std::size_t i = 0; i < drives; ++i) {
    specs.push_back(clean_drive(road_in_turn(i), duration_s, first_seed + i));
    kind.add(specs.back());
  }
  return specs;
}

std::uint64_t first_seed_of(FreshSeeds group, const Options& options) {
  constexpr std::uint64_t kRange = 100'000;
  return options.fresh_seed + kRange * static_cast<std::uint64_t>(group);
}

std::string drives_text(std::size_t drives, double duration_s, std::uint64_t first_seed) {
  return std::to_string(drives) + " drives of " + fixed(duration_s, 0) + " s, seeds from " +
         std::to_string(first_seed) + " on";
}

}  // namespace boresight::bench
