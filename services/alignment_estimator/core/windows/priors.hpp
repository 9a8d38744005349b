// What is known of the parameters before any data.
#pragma once

#include <array>

#include "services/alignment_estimator/core/windows/columns.hpp"

namespace boresight::alignment::windows {

/// Standard deviations; 0: the parameter is not estimated and keeps its nominal value. Origins: "real drives" are
/// docs/alignment.md's four-radar recordings of town and main road; "choice" covers every car that is known.
struct Priors {
  double speed_scale_std = 0.03;     ///< tyres and speedometers (choice)
  double rate_scale_std = 0.003;     ///< between the radars of one car ±0.25 % (real drives)
  double rotation_std_rad = 0.0698;  ///< about each axis, 4° (choice)
  double turned_std_rad = 0.0175;    ///< 1°: of pitch and yaw after a sudden misalignment, as the blocks showed it
  double yaw_rate_bias_std_radps = 0.00175;            ///< 0.1°/s (data sheets of yaw-rate sensors)
  double yaw_rate_gain_std = 0.03;                     ///< 1 % is common (real drives)
  double slip_std_radps2pm = 0.006;                    ///< 0.003…0.006 (literature; real drives 0.0045)
  double pitch_per_acceleration_std_radps2pm = 0.006;  ///< load transfer: 1° at 3 m/s² (choice)
  double common_stamp_std_s = 0.05;      ///< late stamps of 10…80 ms (real drives): the part that all radars share,
  double stamp_std_s = 0.02;             ///< and each radar's own
  double position_std_m = 0.03;          ///< vehicle files are wrong by 2…10 cm (choice)
  double curve_std_rad = 0.00262;        ///< azimuth error by bumper and array, 0.1…0.4° rms (real drives)
  double curve_length_rad = 0.262;       ///< over which it is alike, 15° (choice)
  double height_excess_std = 0.2;        ///< choice
  double mirror_share_std = 1.0;         ///< choice
  double mirror_share_tolerance = 0.15;  ///< the share differs with range and road: it is not known better than this
  double load_std_rad = 0.0105;          ///< change of the load 0.3…0.8° (literature)
  // Fluctuations: medians of their standard deviations, and the standard deviation of the logarithm. Start values: they
  // are learnt.
  std::array<double, kFluctuations> own_std{5e-4, 9e-4, 5e-4};
  std::array<double, kFluctuations> common_std{1.4e-3, 1.7e-3, 3e-4};
  double log_fluctuation_std = 1.0;
  /// An error of the elevations that shows as pitch at the speed V shows as roll at the sideways velocity: V/V_y times
  /// as large, 3 in a turn at a junction. It lasts as long as the scene, so that a turn has one.
  double roll_per_pitch = 10.0;
  double lasting_pitch = 1.5;          ///< of the scatter of a radar's pitch: the part that stays for the drive
  double common_correlation_s = 20.0;  ///< median of their correlation times
  double log_correlation_std = 0.75;
  // Drift of a mounting over the last `drift_span_s`: median of the standard deviation of its rate.
  double drift_std_radps = 9e-7;  ///< 0.003 deg/min (choice)
  double drift_span_s = 180.0;
  // Errors of the motion at one scan, beside those that the ego message states.
  double body_pitch_std_rad = 0.00175;  ///< 0.1° (choice)
  double side_slip_std_rad = 8.7e-4;    ///< 0.05° (choice)
};

}  // namespace boresight::alignment::windows
