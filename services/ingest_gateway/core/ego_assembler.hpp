// Assembles ego signals of all sources to EgoMotion: keeps the latest of each, rejects implausible values.
#pragma once

#include <cstdint>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Limits of plausible ego readings.
struct EgoLimits {
  std::int64_t max_age_ns = 200'000'000;  ///< between the speed and a signal reported with it
  /// A gear position is a state that buses repeat at as little as 1 Hz, not a measurement.
  std::int64_t max_reverse_age_ns = 1'500'000'000;
  double speed_min_mps = -30.0;
  double speed_max_mps = 100.0;
  double yaw_rate_max_radps = 3.0;         ///< a vehicle that spins on ice turns half a circle per second
  double steering_angle_max_rad = 20.0;    ///< three turns of the steering wheel
  double acceleration_max_mps2 = 30.0;     ///< three times the limit of tyres
  unsigned readings_to_accept_a_step = 3;  ///< readings in a row that agree on a new speed
  double acceleration_filter_s = 0.2;      ///< time constant of the derived acceleration
};

/// Keeps the latest signals; every accepted speed completes an ego motion. No allocation.
class EgoAssembler {
 public:
  explicit EgoAssembler(const EgoConfig& config, const EgoLimits& limits = {}) : config_(config), limits_(limits) {}

  struct Result {
    bool complete = false;      ///< an ego motion is complete: call write()
    bool time_jumped = false;   ///< the clock went back by more than max_age_ns: all signals were dropped
    std::string_view rejected;  ///< rejected signal with its reason (static text); empty if none
  };
  /// Takes the signals of one frame. A rejected signal does not affect the others of its frame.
  [[nodiscard]] Result take(const EgoReading& reading, const FrameStamp& stamp);

  /// Writes all fields except the header. Signals too old compared with the speed are zero and not in `fields`.
  void write(EgoMotion& out) const;

  /// Time of the latest accepted speed.
  [[nodiscard]] MeasurementTime time() const { return {speed_.stamp_ns, speed_source_}; }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;
  template <typename T>
  struct Signal {
    T value{};
    std::int64_t stamp_ns = kNever;
  };
  enum class Direction : std::uint8_t { kUnknown, kForward, kReverse };

  [[nodiscard]] static bool is_fresh(std::int64_t stamp_ns, std::int64_t now_ns, std::int64_t max_age_ns);
  [[nodiscard]] std::string_view check_speed(double speed_mps, std::int64_t stamp_ns);
  [[nodiscard]] bool agree(const Signal<double>& earlier, double speed_mps, std::int64_t stamp_ns) const;
  void accept_speed(double speed_mps, bool is_signed, const FrameStamp& stamp);
  void forget();

  EgoConfig config_;
  EgoLimits limits_;
  Signal<double> signalled_speed_;  // as received, before the direction was applied
  Signal<double> speed_;            // with the direction of travel as sign, if known
  Signal<double> yaw_rate_, steering_angle_;
  Signal<bool> reverse_;
  TimeSource speed_source_ = TimeSource::kUnknown;
  Direction direction_ = Direction::kUnknown;
  double acceleration_mps2_ = 0.0;
  Signal<double> step_;  // latest speed that was rejected as a step
  unsigned step_readings_ = 0;
  bool follows_a_step_ = false;
};

}  // namespace boresight::ingest
