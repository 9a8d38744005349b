// A simulated drive as a stream of messages with truth, in the order of measurement.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/car/body.hpp"
#include "services/simulator/radar/radar_sensor.hpp"
#include "services/simulator/scenario_file.hpp"
#include "services/simulator/world.hpp"

namespace boresight::simulator {

/// Speed, yaw rate and steering angle as the vehicle's sensors would signal them, unquantised.
struct EgoSignals {
  double speed_mps;  ///< true speed / k_v, plus noise; in steps if the real car has them
  double yaw_rate_radps;
  double steering_angle_rad;
};

/// The next message of the drive: either ego signals or a scan.
struct Event {
  double t_s = 0.0;
  std::int64_t time_ns = 0;   ///< t_s as stamp, from kStart_ns on
  std::int64_t stamp_ns = 0;  ///< stamp of the message: time_ns, or later by the offset of the radar's stamps
  EgoSignals ego{};
  const RadarScan* scan = nullptr;  ///< nullptr: ego signals; header: source_id, sequences, measurement time
  const std::vector<DetectionTruth>* truth = nullptr;
  std::uint32_t condition = 0;  ///< condition that the scan's radar reports: source_condition bits
};

class Drive {
 public:
  /// Stamps begin here: a fixed date, so that runs are bit-identical.
  static constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
  static constexpr double kEgoPeriod_s = 0.0125;

  Drive(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed, double duration_s);

  /// The next event, or nullptr at the end; valid until the next call. Ego signals precede scans of the same time.
  [[nodiscard]] const Event* next();

  [[nodiscard]] const Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const World& world() const { return world_; }
  /// With side slip and load. The rear axle stays on its path: slip turns the heading away from it.
  [[nodiscard]] EgoState ego(double t_s) const;
  /// The scene of the last scan.
  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  struct Radar {
    RadarConfig config;
    RadarSensor sensor;
    std::int64_t stamp_offset_ns;
    double phase_s;
    std::uint32_t cycle;
  };
  [[nodiscard]] double time_of(const Radar& radar) const;
  [[nodiscard]] double slip_rad(double t_s) const;
  Scenario scenario_;
  std::uint64_t seed_;
  double duration_s_;
  World world_;
  car::SideSlip side_slip_;
  std::vector<Radar> radars_;
  std::uint64_t ego_index_ = 0;
  std::uint64_t sequence_ = 0;
  Scene scene_;
  std::unique_ptr<RadarScan> scan_;
  std::vector<DetectionTruth> truth_;
  Event event_;
};

/// Box of the ego vehicle, which hides targets from its own radars.
[[nodiscard]] radar::EgoBody ego_body(const EgoSpec& ego);

/// Ego signals as the message that the gateway would publish.
[[nodiscard]] EgoMotion to_message(const Event& event, const EgoConfig& config);

}  // namespace boresight::simulator
