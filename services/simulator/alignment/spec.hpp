// Specification of a statistical alignment drive. Detections are drawn independently scan by scan from an exactly known
// truth. Disturbances can be switched on one by one. This simulator measures the accuracy of alignment estimators; the
// simulator of the folder above has a world with persistent objects.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/car/real_car.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator {

enum class RoadKind : std::uint8_t { kCity, kMotorway, kStraight, kSlow, kMixed };
[[nodiscard]] const char* name_of(RoadKind road);

/// Model of range rates as a function of the angles: the exact rotation, or the planar roll model of Burza 2025, (10)
/// and (11), which reproduces its tables.
enum class MountingModel : std::uint8_t { kExact, kPlanar };

/// Distribution of elevations: from heights of reflectors, uniform −0.02…0.06 rad as in Burza 2025, or all zero.
enum class ElevationKind : std::uint8_t { kScene, kUniform, kZero };

struct AlignmentRadar {
  RadarConfig config;              ///< nominal mounting, field of view, noise stds as given to the estimator
  Misalignment truth;              ///< α, β, γ added to the nominal angles
  bool measures_elevation = true;  ///< false: scans lack the field
  bool states_stds = false;        ///< scans carry the stds
  double first_scan_s = 0.0;       ///< radars with different values are not synchronised
  double mean_detections = 60.0;   ///< per scan
  double ambiguity_mps = 0.0;      ///< width of the unambiguous interval, around 0; 0: no folding
  double noise_scale = 1.0;        ///< true angle noise relative to the stated one
};

struct StepChange {
  double time_s = 0.0;                                  ///< of measurement, as AlignmentEvent::time_s
  std::size_t radar = 0;                                ///< index
  Eigen::Vector3d rotation_vehicle_rad{0.0, 0.0, 0.0};  ///< rotation d about the vehicle axes: Exp(d)·R
};

struct AlignmentSpec {
  double duration_s = 180.0;
  RoadKind road = RoadKind::kMixed;
  std::uint64_t seed = 1;
  double speed_scale = 1.01;           ///< k_v
  std::vector<AlignmentRadar> radars;  ///< with any ids; `config.noise` is also the true noise
  MountingModel model = MountingModel::kExact;
  ElevationKind elevation = ElevationKind::kScene;
  double ego_rate_hz = 20.0;
  /// Share of detections that are not stationary: vehicles with and against the traffic, slow walkers, ghosts.
  double outlier_share = 0.25;
  double azimuth_std_edge = 0.35;  ///< azimuth noise grows as 1/max(cos α, this); 1: constant
  double speed_std_mps = 0.02;     ///< white noise per message
  double yaw_rate_std_radps = 0.001;
  double yaw_rate_bias_radps = 0.0;        ///< signalled = true + bias
  double slip_coefficient_radps2pm = 0.0;  ///< V_y = −c·V·(V·ω)
  double body_pitch_std_rad = 0.0;         ///< Ornstein–Uhlenbeck
  double body_pitch_correlation_s = 0.3;
  double body_pitch_per_acceleration_radps2pm = 0.0;  ///< nose down when braking
  std::vector<StepChange> step_changes;
  car::RealCar real_car{};  ///< its yaw-rate bias and slip coefficient add to those above

  [[nodiscard]] double total_yaw_rate_bias_radps() const { return yaw_rate_bias_radps + real_car.yaw_rate_bias_radps; }
  [[nodiscard]] double total_slip_coefficient_radps2pm() const {
    return slip_coefficient_radps2pm + real_car.slip_coefficient_radps2pm;
  }
};

/// Four corner radars, as in drive_1: noise, mounting and truth of Burza 2025, Table 1.
[[nodiscard]] AlignmentSpec four_corner_radars();
/// The published set-up: planar truth, slow drive, no outliers, residuals of 0.20 → 0.027 m/s.
[[nodiscard]] AlignmentSpec published_setup();
/// The radars of a vehicle, with its stds of the ego signals. Their misalignments are those of Table 1 in turn. Their
/// sources become those of ARS548, since the drive's files use that profile.
[[nodiscard]] AlignmentSpec radars_of(const VehicleConfig& vehicle);
/// Draws the truth from the seed: k_v in 0.97…1.03, each angle within ±3°.
void draw_truth(AlignmentSpec& spec);

}  // namespace boresight::simulator
