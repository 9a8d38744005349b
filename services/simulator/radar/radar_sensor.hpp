// The measurement of one radar at an instant: propagation, detection, the radar's statistics, noise.
#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/detection_truth.hpp"
#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/cells.hpp"
#include "services/simulator/radar/ego_body.hpp"
#include "services/simulator/radar/one_way.hpp"
#include "services/simulator/radar/returns/statistical_returns.hpp"
#include "services/simulator/radar/round_trip.hpp"
#include "services/simulator/radar_effects.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

class RadarSensor {
 public:
  RadarSensor(const RadarConfig& config, const RadarEffects& effects, const radar::EgoBody& ego_body,
              std::uint64_t seed);

  /// Measures the scene in the given cycle. Writes all of `scan` except the header, strongest detection first, and the
  /// truth of each detection. Detections beyond the capacity are counted in `dropped_detections`. The same seed, scene
  /// and cycle give the same scan, whatever was measured before.
  void measure(const Scene& scene, std::uint32_t cycle, RadarScan& scan, std::vector<DetectionTruth>& truth);

  /// The condition that the sensor reports at that time: source_condition bits.
  [[nodiscard]] std::uint32_t condition(double t_s) const;

 private:
  void add_bodies(const Scene& scene, const Eigen::Matrix3d& world_to_sensor);
  void add_scatterers(const Scene& scene, const Eigen::Matrix3d& world_to_sensor);
  void add(const radar::Target& target, bool with_mirrors, double embedded_m, const Eigen::Matrix3d& world_to_sensor);
  void fluctuate(std::uint64_t cycle_key, double noise_rise_db);
  void keep_detected(std::uint64_t cycle_key);
  void add_false_detections(std::uint32_t cycle, double interference_per_scan);
  /// What the real car makes of an echo: the road mirrors its elevation, the bumper bends its azimuth.
  void distort(radar::Echo& echo, std::uint64_t cycle_key) const;
  void write(std::uint32_t cycle, RadarScan& scan, std::vector<DetectionTruth>& truth) const;

  RadarConfig config_;
  RadarEffects effects_;
  std::uint64_t seed_;
  car::RadarOfCar of_car_;
  MountingPose true_position_;
  radar::EgoBox ego_box_;
  double swerling_order_;
  radar::Viewpoint view_{};
  std::vector<radar::Dirt> dirt_;
  radar::Antenna antenna_;
  radar::Propagation propagation_;
  radar::Cells cells_;
  std::vector<radar::OneWay> paths_;
  std::vector<radar::Echo> echoes_, false_echoes_;
  radar::StatisticalReturns returns_;
  double rcs_offset_db_;  // of this radar's scale, for the whole drive
};

}  // namespace boresight::simulator
