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
    /// Nominal yaw, pitch and roll, as the file says.
    std::array<std::optional<double>, 3> mount_rad;
    std::array<double, 3> sensor_rad{};  ///< α, β, γ
  };
  /// From `time_s` on a radar is mounted otherwise.
  struct StepChange {
    double time_s = 0.0;
    std::uint32_t radar = 0;
    std::array<double, 3> sensor_rad{};
  };
  std::map<std::uint32_t, Radar> radars;  ///< by id
  std::vector<StepChange> step_changes;   ///< in the order of time
};

/// Lines "k_v VALUE", and "radar ID", "step_change" and "disturbance" with pairs "key value"; others (and comments) are
/// for other readers. /// Throws std::runtime_error naming line and cause if a number is missing or none of these lines
/// is there.
[[nodiscard]] Truth read_truth(std::istream& input, const std::string& name);

/// R(sensor→vehicle) = R_z(yaw_b+α)·R_y(−(pitch_b+β))·R_x(roll_b+γ); what the truth does not say of the nominal
/// mounting is that of the vehicle file.
[[nodiscard]] Eigen::Matrix3d true_mounting(const Truth::Radar& truth, const MountingPose& nominal);

}  // namespace boresight::align
