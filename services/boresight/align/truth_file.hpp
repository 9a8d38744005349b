// The truth of a simulated drive, in the format of alignment_drive/truth_1.txt.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

struct Truth {
  std::optional<double> speed_scale;
  std::optional<double> yaw_rate_bias_radps;
  std::optional<double> slip_coefficient_radps2pm;
  struct Radar {
    /// Nominal yaw, pitch and roll, if the file states them.
    std::array<std::optional<double>, 3> mount_rad;
    std::array<double, 3> sensor_rad{};  ///< α, β, γ
  };
  /// A new mounting of a radar from `time_s` on.
  struct StepChange {
    double time_s = 0.0;
    std::uint32_t radar = 0;
    std::array<double, 3> sensor_rad{};
  };
  std::map<std::uint32_t, Radar> radars;  ///< by id
  std::vector<StepChange> step_changes;   ///< in the order of time
};

/// Reads lines "k_v VALUE", and lines "radar ID", "step_change" and "disturbance" with pairs "key value"; other lines
/// are skipped. Throws std::runtime_error, which names line and cause, if a number is missing or no such line exists.
[[nodiscard]] Truth read_truth(std::istream& input, const std::string& name);

/// R(sensor→vehicle) = R_z(yaw_b+α)·R_y(−(pitch_b+β))·R_x(roll_b+γ). Nominal angles that the truth does not state are
/// taken from the vehicle file.
[[nodiscard]] Eigen::Matrix3d true_mounting(const Truth::Radar& truth, const MountingPose& nominal);

}  // namespace boresight::align
