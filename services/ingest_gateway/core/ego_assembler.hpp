// Ego signals of whatever source → EgoMotion: keeps the latest of each, drops what cannot be, says what is missing.
#pragma once

#include <cstdint>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// What of an ego reading is believed.
struct EgoLimits {
  std::int64_t max_age_ns = 200'000'000;  ///< between the speed and a signal told with it
  /// A gear position is a state that buses repeat at as little as 1 Hz, not a measurement.
  std::int64_t max_reverse_age_ns = 1'500'000'000;
  double speed_min_mps = -30.0;
  double speed_max_mps = 100.0;
  double yaw_rate_max_radps = 3.0;         ///< a car spinning on ice turns half a circle in a second
  double steering_angle_max_rad = 20.0;    ///< three turns of the steering wheel
  double acceleration_max_mps2 = 30.0;     ///< three times what tyres can do
  unsigned readings_to_accept_a_step = 3;  ///< that agree on a new speed
  double acceleration_filter_s = 0.2;      ///< time constant of the derived acceleration
};

/// Keeps the latest signals; every accepted speed completes an ego motion. No allocation.
class EgoAssembler {
 public:
  explicit EgoAssembler(const EgoConfig& config, const EgoLimits& limits = {}) : config_(config), limits_(limits) {}

  struct Result {
    bool complete = false;      ///< an ego motion is due: write() it
    bool time_jumped = false;   ///< the clock went back by more than the greatest age: all signals were forgotten
    std::string_view rejected;  ///< which signal was not taken and why (static text); empty if all were
  };
  /// Takes the signals of one frame. A signal that is rejected does not stop the others of its frame.
  [[nodiscard]] Result take(const EgoReading& reading, const FrameStamp& stamp);

  /// Writes all fields but the header. Signals too old beside the speed are left out of `fields` and are zero.
  void write(EgoMotion& out) const;

  /// Of the latest accepted speed.
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
  Signal<double> signalled_speed_;  // as it came, before the direction was applied
  Signal<double> speed_;            // with the direction of travel as sign where that is known
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
