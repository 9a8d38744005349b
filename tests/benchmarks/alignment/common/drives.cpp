#include "tests/benchmarks/alignment/common/drives.hpp"

#include <cmath>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/random.hpp"

namespace boresight::bench {

using simulator::AlignmentRadar;
using simulator::AlignmentSpec;
using simulator::RoadKind;
using simulator::Stream;

double draw_mounting_error(Stream& stream) {
  const double magnitude = stream.uniform(1.0, 2.5) * kRadiansPerDegree;
  return stream.uniform() < 0.5 ? -magnitude : magnitude;
}

double draw_speed_scale(Stream& stream) {
  return stream.uniform(0.98, 1.02);
}

namespace {

void misalign(AlignmentSpec& spec) {
  Stream stream(spec.seed, "bench truth");
  spec.speed_scale = draw_speed_scale(stream);
  for (AlignmentRadar& radar : spec.radars) {
    radar.truth.yaw_rad = draw_mounting_error(stream);
    radar.truth.pitch_rad = draw_mounting_error(stream);
    radar.truth.roll_rad = draw_mounting_error(stream);
  }
}

void disturb(AlignmentSpec& spec) {
  Stream stream(spec.seed, "bench disturbances");
  spec.yaw_rate_bias_radps = (stream.uniform() < 0.5 ? -0.1 : 0.1) * kRadiansPerDegree;
  spec.slip_coefficient_radps2pm = stream.uniform(0.003, 0.006);
  spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  spec.body_pitch_per_acceleration_radps2pm = 0.2 * kRadiansPerDegree;
}

AlignmentRadar radar_at(const AlignmentRadar& like, std::uint32_t id, double x_m, double y_m, double yaw_deg) {
  AlignmentRadar radar = like;
  radar.config.id = id;
  radar.config.name = "radar_" + std::to_string(id);
  radar.config.mounting_pose.position_m = {x_m, y_m, 0.5};
  radar.config.mounting_pose.yaw_rad = yaw_deg * kRadiansPerDegree;
  return radar;
}

template <RoadKind kRoad>
AlignmentSpec clean(double duration_s, std::uint64_t seed) {
  return clean_drive(kRoad, duration_s, seed);
}
template <RoadKind kRoad>
AlignmentSpec disturbed(double duration_s, std::uint64_t seed) {
  return disturbed_drive(kRoad, duration_s, seed);
}

AlignmentSpec unsynchronised(double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
  const double cycles_s[] = {0.05, 0.06, 0.07, 0.04};
  for (std::size_t r = 0; r < spec.radars.size(); ++r) {
    spec.radars[r].first_scan_s = 0.0137 * static_cast<double>(r);
    spec.radars[r].config.cycle_time_s = cycles_s[r];
  }
  return spec;
}

/// One ahead, two at corners and one behind. The second is upside down, the third has ambiguous range rates, the fourth
/// measures no elevation; the last two state no stds.
AlignmentSpec mixed_radars(double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
  const AlignmentRadar like = spec.radars[0];
  spec.radars = {radar_at(like, 1, 3.8, 0.0, 0.0), radar_at(like, 2, 3.65, -0.75, -45.0),
                 radar_at(like, 3, -0.85, 0.7, 135.0), radar_at(like, 4, -1.0, 0.0, 180.0)};
  spec.radars[1].config.mounting_pose.roll_rad = M_PI;
  spec.radars[2].ambiguity_mps = 30.0;
  spec.radars[2].states_stds = false;
  spec.radars[3].measures_elevation = false;
  spec.radars[3].states_stds = false;
  misalign(spec);
  return spec;
}

AlignmentSpec one_radar(double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
  spec.radars.resize(1);
  return spec;
}

AlignmentSpec sixteen_radars(double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
  const AlignmentRadar like = spec.radars[0];
  spec.radars.clear();
  for (std::uint32_t i = 0; i < kMaxRadars; ++i) {
    const double yaw_deg = -180.0 + 22.5 * static_cast<double>(i);
    const double x_m = 1.4 + 2.3 * std::cos(yaw_deg * kRadiansPerDegree),
                 y_m = 0.8 * std::sin(yaw_deg * kRadiansPerDegree);
    spec.radars.push_back(radar_at(like, i + 1, x_m, y_m, yaw_deg));
    spec.radars.back().mean_detections = 30.0;
  }
  misalign(spec);
  return spec;
}

/// Sensors whose angle noise is 1.6 times what they state.
AlignmentSpec understated_noise(double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(RoadKind::kMixed, duration_s, seed);
  for (AlignmentRadar& radar : spec.radars) radar.noise_scale = 1.6;
  return spec;
}

}  // namespace

AlignmentSpec clean_drive(RoadKind road, double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = simulator::four_corner_radars();
  spec.road = road;
  spec.duration_s = duration_s;
  spec.seed = seed;
  misalign(spec);
  return spec;
}

AlignmentSpec disturbed_drive(RoadKind road, double duration_s, std::uint64_t seed) {
  AlignmentSpec spec = clean_drive(road, duration_s, seed);
  disturb(spec);
  return spec;
}

const std::vector<DriveKind>& drive_kinds() {
  static const std::vector<DriveKind> kinds = {
      {"city", clean<RoadKind::kCity>},
      {"motorway", clean<RoadKind::kMotorway>},
      {"mixed", clean<RoadKind::kMixed>},
      {"straight", clean<RoadKind::kStraight>},
      {"slow", clean<RoadKind::kSlow>},
      {"disturbed city", disturbed<RoadKind::kCity>},
      {"disturbed mixed", disturbed<RoadKind::kMixed>},
      {"unsynchronised", unsynchronised},
      {"mixed radars", mixed_radars},
      {"one radar", one_radar},
      {"16 radars", sixteen_radars},
      {"understated noise", understated_noise},
  };
  return kinds;
}

}  // namespace boresight::bench
