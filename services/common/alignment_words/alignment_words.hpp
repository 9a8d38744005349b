// What an alignment estimate says, in words: reason, wrong input, changes and drift. One room, so that health, logs,
// tables and JSON use the same sentences. Sentences begin in lower case and have no full stop.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/health_report.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment_words {

/// Keys for JSON and CSV: "large_std", "radars_swapped"; "none".
[[nodiscard]] std::string_view key_of(AlignmentReason reason);
[[nodiscard]] std::string_view key_of(AlignmentFinding finding);

/// "front_left" of the vehicle file, else "radar 7".
[[nodiscard]] std::string radar_name(const VehicleConfig& vehicle, std::uint32_t radar);

/// A wrong input as the estimate contains it.
struct Finding {
  AlignmentFinding kind = AlignmentFinding::kNone;
  double value = 0.0;             ///< see AlignmentFinding
  std::uint32_t other_radar = 0;  ///< id; 0: none
};
[[nodiscard]] Finding finding_of(const AlignmentEstimate& estimate);

/// "left and right radars swapped: 'front_left' sees what 'front_right' should see", "nominal yaw of 'front_left' is
/// wrong by +90°", "speed signal in km/h (3.6 times too large)"; empty without a finding.
[[nodiscard]] std::string sentence_of(const Finding& finding, std::uint32_t radar, const VehicleConfig& vehicle);

/// "the standard deviation is still above the configured one"; empty for kNone.
[[nodiscard]] std::string_view words_of(AlignmentReason reason);
/// The finding's sentence if there is one, else the words of the reason; empty if neither.
[[nodiscard]] std::string reason_of(const AlignmentEstimate& estimate, const VehicleConfig& vehicle);

/// "+2.490 ± 0.021°": two significant digits of the standard deviation.
[[nodiscard]] std::string angle_text(double value_rad, double std_rad);
/// "1.5°": no more digits than the number needs.
[[nodiscard]] std::string tolerance_text(double tolerance_rad);
/// "load changed the vehicle's pitch by +0.78° (nose up)"; empty if it was never reported.
[[nodiscard]] std::string load_change_sentence(const AlignmentVehicleChange& change);
/// "scale of the speed signal changed by +1.20 %"; empty if it was never reported.
[[nodiscard]] std::string speed_change_sentence(const AlignmentVehicleChange& change);
/// "yaw drifts by +0.131 ± 0.012°/min" with the axes whose rate exceeds twice its σ; empty if no drift is reported.
[[nodiscard]] std::string drift_sentence(const AlignmentDrift& drift);

/// The axes beyond their tolerance with their effect: "yaw +2.490 ± 0.021°, reduced: beyond 1.5°"; empty if none is.
[[nodiscard]] std::string beyond_tolerance(const AxisHealth& yaw, const AxisHealth& pitch, const AxisHealth& roll);
/// Consequences of the mounting error: "4.4 m at 100 m, 3 % of the view lost, 1 % of the range lost, velocities wrong
/// by 0.9 m/s". Except for the displacement, those that round to zero are not included.
[[nodiscard]] std::string consequences(const SensorHealth& sensor);
/// The whole message of a radar's verdict behind its qualifiers: wrong input, axes beyond tolerance with their
/// consequences, drift, changes of the vehicle, or why the estimate is not converged; empty if there is nothing to say.
[[nodiscard]] std::string explanation_of(const SensorHealth& sensor, const VehicleConfig& vehicle);

}  // namespace boresight::alignment_words
