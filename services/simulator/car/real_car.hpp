// Effects of a real car that the model of the alignment estimator does not know. The world simulator and the
// statistical drive simulator share them.
#pragma once

namespace boresight::simulator::car {

/// Sizes of the effects. Each of them is off at 0, and has random streams of its own.
struct RealCar {
  /// Each radar multiplies its range rates by 1 + e, with e drawn from ± this.
  double range_rate_scale = 0.0;
  /// Error of the measured azimuth as a smooth curve over the field of view: its root mean square. Bumper and array.
  double azimuth_curve_rms_rad = 0.0;
  /// Horizontal distance of a radar's true position from the vehicle file's. Each radar has a direction of its own.
  double position_error_m = 0.0;
  /// Stamps are later than the measurement by a constant of each radar, drawn from half of this up to this.
  double stamp_offset_s = 0.0;
  /// Side slip of the rear axle by crosswind and road camber: an Ornstein–Uhlenbeck process, positive to the left.
  double side_slip_std_rad = 0.0;
  double side_slip_correlation_s = 20.0;
  /// Side slip in bends: −this times the lateral acceleration (V_y = −c·V·(V·ω)).
  double slip_coefficient_radps2pm = 0.0;
  /// Load: from `load_time_s` on the body is pitched, positive with the nose up. All radars turn with it.
  double load_pitch_rad = 0.0;
  double load_time_s = 30.0;
  /// Signalled yaw rate = (1 + gain) · true yaw rate + bias.
  double yaw_rate_gain = 0.0;
  double yaw_rate_bias_radps = 0.0;
  /// The signalled speed is a whole multiple of this.
  double speed_step_mps = 0.0;
  /// Share of the detections of low reflectors whose elevation is that of the reflector's mirror image in the road.
  double road_mirror_share = 0.0;
  [[nodiscard]] bool operator==(const RealCar&) const = default;
};

/// All effects together. config/schema/scenario.md states the origin of each size.
[[nodiscard]] RealCar real_car_preset();

}  // namespace boresight::simulator::car
