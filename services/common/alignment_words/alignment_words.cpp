#include "services/common/alignment_words/alignment_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "interfaces/messages/names.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::alignment_words {

namespace {

constexpr double kKmhPerMps = 3.6;
constexpr double kMphPerMps = 2.23694;
/// A factor that differs by less is taken for the unit's. Choice: far above the scale errors of speed signals (1 … 3
/// %).
constexpr double kUnitTolerance = 0.05;

bool is_close(double factor, double unit) {
  return std::abs(factor / unit - 1.0) < kUnitTolerance;
}

/// "3.6 times too large", "0.5 times the true value".
std::string factor_text(double factor) {
  return factor > 1.0 ? fmt::format("{:.3g} times too large", factor)
                      : fmt::format("{:.3g} times the true value", factor);
}

std::string speed_unit_text(double factor) {
  if (is_close(factor, kKmhPerMps)) return fmt::format("speed signal in km/h ({})", factor_text(factor));
  if (is_close(factor, kMphPerMps)) return fmt::format("speed signal in mph ({})", factor_text(factor));
  return "unit of the speed signal wrong: " + factor_text(factor);
}

std::string yaw_rate_unit_text(double factor) {
  if (is_close(factor, kDegreesPerRadian)) return fmt::format("yaw rate in °/s ({})", factor_text(factor));
  return "unit of the yaw rate wrong: " + factor_text(factor);
}

/// Where two radars that were swapped belong.
std::string_view pair_text(const RadarConfig* a, const RadarConfig* b) {
  if (a == nullptr || b == nullptr) return "radars";
  const auto& p = a->mounting_pose.position_m;
  const auto& q = b->mounting_pose.position_m;
  const bool opposite_sides = p[1] * q[1] < 0.0;
  const double along_m = std::abs(p[0] - q[0]), across_m = std::abs(p[1] - q[1]);
  if (opposite_sides && across_m > along_m) return "left and right radars";
  if (!opposite_sides && along_m > across_m) return "front and rear radars";
  return "radars";
}

void append(std::string& text, std::string_view part) {
  if (part.empty()) return;
  if (!text.empty()) text += "; ";
  text += part;
}

}  // namespace

std::string_view key_of(AlignmentReason reason) {
  constexpr std::array<std::string_view, 11> kKeys = {
      "none",        "wrong_input",    "no_ego_motion",  "too_slow",  "too_few_detections", "no_consistent_start",
      "few_inliers", "large_residual", "not_observable", "large_std", "short_drive"};
  return detail::word_of(kKeys, reason);
}

std::string_view key_of(AlignmentFinding finding) {
  constexpr std::array<std::string_view, 14> kKeys = {"none",
                                                      "radars_swapped",
                                                      "other_radar",
                                                      "nominal_yaw_wrong",
                                                      "azimuth_mirrored",
                                                      "range_rate_mirrored",
                                                      "yaw_rate_mirrored",
                                                      "azimuth_or_yaw_rate",
                                                      "speed_unit",
                                                      "yaw_rate_unit",
                                                      "speed_frozen",
                                                      "speed_zero",
                                                      "ego_motion_missing",
                                                      "copied_detections"};
  return detail::word_of(kKeys, finding);
}

std::string radar_name(const VehicleConfig& vehicle, std::uint32_t radar) {
  const RadarConfig* const config = vehicle.radar(radar);
  return config != nullptr ? config->name : fmt::format("radar {}", radar);
}

Finding finding_of(const AlignmentEstimate& estimate) {
  return {estimate.finding, estimate.finding_value, estimate.finding_radar};
}

std::string sentence_of(const Finding& finding, std::uint32_t radar, const VehicleConfig& vehicle) {
  const std::string name = radar_name(vehicle, radar), other = radar_name(vehicle, finding.other_radar);
  switch (finding.kind) {
    case AlignmentFinding::kNone:
      return {};
    case AlignmentFinding::kRadarsSwapped:
      return fmt::format("{} swapped: '{}' sees what '{}' should see",
                         pair_text(vehicle.radar(radar), vehicle.radar(finding.other_radar)), name, other);
    case AlignmentFinding::kOtherRadar:
      return fmt::format("the detections of '{}' are those of '{}'", name, other);
    case AlignmentFinding::kNominalYawWrong:
      return fmt::format("nominal yaw of '{}' is wrong by {}", name,
                         text::fixed(finding.value * kDegreesPerRadian, 0, "°", text::Sign::kAlways));
    case AlignmentFinding::kAzimuthMirrored:
      return fmt::format("sign of the azimuths of '{}' mirrored", name);
    case AlignmentFinding::kRangeRateMirrored:
      return fmt::format("sign of the range rates of '{}' mirrored", name);
    case AlignmentFinding::kYawRateMirrored:
      return "sign of the yaw rate mirrored";
    case AlignmentFinding::kAzimuthOrYawRate:
      return fmt::format("sign of the azimuths of '{}' or of the yaw rate mirrored; one radar cannot tell which", name);
    case AlignmentFinding::kSpeedUnit:
      return speed_unit_text(finding.value);
    case AlignmentFinding::kYawRateUnit:
      return yaw_rate_unit_text(finding.value);
    case AlignmentFinding::kSpeedFrozen:
      return "speed signal frozen: it does not follow the range rates";
    case AlignmentFinding::kSpeedZero:
      return "speed signal is zero although the vehicle moves";
    case AlignmentFinding::kEgoMotionMissing:
      return fmt::format("no valid speed or yaw rate although '{}' sees motion", name);
    case AlignmentFinding::kCopiedDetections:
      return fmt::format("scans of '{}' consist of copies of one detection", name);
  }
  return fmt::format("unknown wrong input of '{}'", name);
}

std::string_view words_of(AlignmentReason reason) {
  constexpr std::array<std::string_view, 11> kWords = {"",
                                                       "an input is wrong",
                                                       "no valid speed and yaw rate at the time of the scans",
                                                       "the vehicle is too slow",
                                                       "too few detections in the scans",
                                                       "no mounting near the nominal one explains the range rates",
                                                       "too few detections agree with stationary reflectors",
                                                       "the residuals exceed the stated noise by far",
                                                       "the drive does not determine the yaw",
                                                       "the standard deviation is still above the configured one",
                                                       "not enough driving time yet"};
  return detail::word_of(kWords, reason);
}

std::string reason_of(const AlignmentEstimate& estimate, const VehicleConfig& vehicle) {
  const std::string sentence = sentence_of(finding_of(estimate), estimate.header.source_id, vehicle);
  return sentence.empty() ? std::string(words_of(estimate.reason)) : sentence;
}

std::string angle_text(double value_rad, double std_rad) {
  return text::with_std(value_rad * kDegreesPerRadian, std_rad * kDegreesPerRadian, "°", text::Sign::kAlways);
}

std::string tolerance_text(double tolerance_rad) {
  return fmt::format("{:.3g}°", tolerance_rad * kDegreesPerRadian);
}

std::string load_change_sentence(const AlignmentVehicleChange& change) {
  if (change.count == 0) return {};
  return fmt::format("load changed the vehicle's pitch by {} (nose {})",
                     text::fixed(change.size * kDegreesPerRadian, 2, "°", text::Sign::kAlways),
                     change.size < 0.0F ? "down" : "up");
}

std::string speed_change_sentence(const AlignmentVehicleChange& change) {
  if (change.count == 0) return {};
  return "scale of the speed signal changed by " + text::fixed(change.size * 100.0, 2, " %", text::Sign::kAlways);
}

std::string drift_sentence(const AlignmentDrift& drift) {
  if (drift.since_ns == 0) return {};
  constexpr double kSecondsPerMinute = 60.0;
  constexpr double kSignificant_sigma = 2.0;
  const auto rate = [](double value_radps, double std_radps) {
    return text::with_std(value_radps * kSecondsPerMinute * kDegreesPerRadian,
                          std_radps * kSecondsPerMinute * kDegreesPerRadian, "°/min", text::Sign::kAlways);
  };
  const bool pitch_drifts = std::abs(drift.pitch_radps) > kSignificant_sigma * drift.pitch_std_radps;
  const bool yaw_drifts = !pitch_drifts || std::abs(drift.yaw_radps) > kSignificant_sigma * drift.yaw_std_radps;
  std::string text;
  if (yaw_drifts) text = "yaw drifts by " + rate(drift.yaw_radps, drift.yaw_std_radps);
  if (pitch_drifts) {
    text += (text.empty() ? "" : ", ") + ("pitch drifts by " + rate(drift.pitch_radps, drift.pitch_std_radps));
  }
  return text;
}

std::string beyond_tolerance(const AxisHealth& yaw, const AxisHealth& pitch, const AxisHealth& roll) {
  std::string text;
  for (const auto& [name, axis] : {std::pair{"yaw", yaw}, std::pair{"pitch", pitch}, std::pair{"roll", roll}}) {
    if (axis.beyond_tolerance == 0) continue;
    const bool is_beyond_limit = axis.effect == AxisEffect::kNotAvailable;
    append(text, fmt::format("{} {}, {}: beyond {}", name, angle_text(axis.error_rad, axis.std_rad),
                             name_of(is_beyond_limit ? AxisEffect::kNotAvailable : AxisEffect::kReduced),
                             tolerance_text(is_beyond_limit ? axis.limit_rad : axis.tolerance_rad)));
  }
  return text;
}

std::string consequences(const SensorHealth& sensor) {
  constexpr float kWorthNaming_ratio = 0.005F;  // rounds to 1 %
  constexpr float kWorthNaming_mps = 0.05F;     // rounds to 0.1 m/s
  std::string text = fmt::format("{} at {:.0f} m", text::fixed(std::abs(sensor.lateral_displacement_m), 1, " m"),
                                 sensor.reference_range_m);
  if (sensor.lost_coverage_ratio >= kWorthNaming_ratio) {
    text += fmt::format(", {:.0f} % of the view lost", 100.0F * sensor.lost_coverage_ratio);
  }
  if (sensor.range_loss_ratio >= kWorthNaming_ratio) {
    text += fmt::format(", {:.0f} % of the range lost", 100.0F * sensor.range_loss_ratio);
  }
  if (sensor.velocity_error_mps >= kWorthNaming_mps) {
    text += fmt::format(", velocities wrong by {:.1f} m/s", sensor.velocity_error_mps);
  }
  return text;
}

std::string explanation_of(const SensorHealth& sensor, const VehicleConfig& vehicle) {
  std::string text =
      sentence_of({sensor.finding, sensor.finding_value, sensor.finding_radar}, sensor.radar_id, vehicle);
  const std::string axes = beyond_tolerance(sensor.yaw, sensor.pitch, sensor.roll);
  append(text, axes);
  if (!axes.empty()) append(text, consequences(sensor));
  append(text, drift_sentence(sensor.drift));
  if (text.empty()) text = words_of(sensor.reason);
  return text;
}

}  // namespace boresight::alignment_words
