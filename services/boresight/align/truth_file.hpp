// The truth of a simulated drive: the text of an alignment drive, or the tables of a drive (config/schema/truth.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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
  std::map<std::uint32_t, Radar> radars;              ///< by id
  std::map<std::uint32_t, double> range_rate_scales;  ///< measured / true range rate by radar id, where it is not 1
  std::vector<StepChange> step_changes;               ///< in the order of time
  /// The speed scale that an estimator sees through this radar (speed_scale_seen()); nothing if k_v is not known.
  [[nodiscard]] std::optional<double> speed_scale_seen_by(std::uint32_t radar) const;
};

/// Reads lines "k_v VALUE", lines "radar ID", "step_change" and "disturbance" with pairs "key value", and
/// "real_car range_rate_scale VALUE 1 radar ID". Comments (#), empty lines, other effects of "real_car", and the lines
/// "noise", "stationary", "crlb_sd" and "prototype" hold no truth that is compared, and are passed over. Throws
/// std::runtime_error, which names line and cause, for any other line, if a number is missing, or if no truth is
/// stated.
[[nodiscard]] Truth read_truth(std::istream& input, const std::string& name);

/// Reads what is there: a folder with truth.csv or truth_sensors.csv of a simulated drive, truth.csv itself, or the
/// text of an alignment drive. `origin_s` is the time 0 of the tables on the recording's clock; the text has the
/// recording's own clock. Throws std::runtime_error as above.
[[nodiscard]] Truth read_truth_at(const std::filesystem::path& where, double origin_s);

/// R(sensor→vehicle) = R_z(yaw_b+α)·R_y(−(pitch_b+β))·R_x(roll_b+γ). Nominal angles that the truth does not state are
/// taken from the vehicle file.
[[nodiscard]] Eigen::Matrix3d true_mounting(const Truth::Radar& truth, const MountingPose& nominal);

}  // namespace boresight::align
