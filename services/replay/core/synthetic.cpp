#include "services/replay/core/synthetic.hpp"

#include <algorithm>

#include "services/common/geometry/frames.hpp"

namespace boresight::replay {

namespace {

/// SplitMix64 (Steele et al. 2014): random numbers that depend only on their seed, equal on all platforms.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// Uniform in min…max.
  double between(double min, double max) {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return min + (max - min) * static_cast<double>(z >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

void write_synthetic_scan(std::uint32_t radar, const MountingPose& mounting, std::uint32_t cycle, std::uint32_t count,
                          RadarScan& scan) {
  constexpr double kRangeRateStd_mps = 0.05;
  Random random(static_cast<std::uint64_t>(radar) << 32 | cycle);
  const Eigen::Matrix3d rotation = geometry::sensor_to_vehicle(mounting.yaw_rad, mounting.pitch_rad, mounting.roll_rad);
  const Eigen::Vector3d velocity = geometry::sensor_velocity(1.0, kSyntheticSpeed_mps, 0.0, mounting.position_m);
  scan.cycle_counter = cycle;
  scan.number_of_valid_detections = std::min<std::uint32_t>(count, kMaxDetections);
  scan.dropped_detections = 0;
  scan.fields = scan_field::kElevation | scan_field::kRcs | scan_field::kSnr | scan_field::kStds |
                scan_field::kExistence | scan_field::kAmbiguity;
  scan.range_rate_min_mps = -60.0F;
  scan.range_rate_max_mps = 60.0F;
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const double azimuth_rad = random.between(-1.0, 1.0);
    const double elevation_rad = random.between(-0.2, 0.2);
    // The sum of four uniform numbers approximates a normal distribution.
    double normal = 0.0;
    for (int k = 0; k < 4; ++k) normal += random.between(-0.866, 0.866);
    const double range_rate_mps =
        geometry::stationary_range_rate(rotation * geometry::direction(azimuth_rad, elevation_rad), velocity) +
        kRangeRateStd_mps * normal;
    scan.range_m[i] = static_cast<float>(random.between(2.0, 150.0));
    scan.azimuth_rad[i] = static_cast<float>(azimuth_rad);
    scan.elevation_rad[i] = static_cast<float>(elevation_rad);
    scan.range_rate_mps[i] = static_cast<float>(range_rate_mps);
    scan.rcs_dbsm[i] = static_cast<float>(random.between(-10.0, 20.0));
    scan.snr_db[i] = static_cast<float>(random.between(10.0, 40.0));
    scan.range_std_m[i] = 0.2F;
    scan.azimuth_std_rad[i] = 0.005F;
    scan.elevation_std_rad[i] = 0.01F;
    scan.range_rate_std_mps[i] = static_cast<float>(kRangeRateStd_mps);
    scan.existence_probability[i] = static_cast<float>(random.between(0.5, 1.0));
    scan.detection_flags[i] = 0;
  }
}

void write_synthetic_ego(EgoMotion& ego) {
  ego.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle | ego_field::kReverse;
  ego.speed_mps = kSyntheticSpeed_mps;
  ego.speed_std_mps = 0.0F;
  ego.yaw_rate_radps = 0.0F;
  ego.yaw_rate_std_radps = 0.0F;
  ego.steering_angle_rad = 0.0F;
  ego.steering_angle_std_rad = 0.0F;
  ego.longitudinal_acceleration_mps2 = 0.0F;
}

}  // namespace boresight::replay
