// The estimate that is kept over ignition cycles.
#pragma once

#include <array>
#include <cstdint>

#include "interfaces/messages/header.hpp"

namespace boresight::alignment {

/// State of the vehicle's alignment. Parameters of the covariance in this order: k_v, yaw-rate bias (rad/s), slip
/// coefficient (rad per m/s²), then per radar the rotation about the vehicle's x, y and z axes.
struct Memory {
  static constexpr std::size_t kShared = 3;
  static constexpr std::size_t kMaxParameters = kShared + 3 * kMaxRadars;
  struct Radar {
    std::uint32_t id = 0;
    std::array<double, 3> rotation_vehicle_rad{};  ///< vector d of R(actual) = Exp(d)·R(nominal)
    double angle_noise_scale = 1.0;
    double seconds_of_drive = 0.0;
  };
  std::size_t number_of_radars = 0;
  double speed_scale = 1.0;
  double yaw_rate_bias_radps = 0.0;
  double slip_coefficient_radps2pm = 0.0;
  std::array<Radar, kMaxRadars> radars{};
  /// Row-major with `number_of_parameters()` rows and columns.
  std::array<double, kMaxParameters * kMaxParameters> covariance{};

  [[nodiscard]] std::size_t number_of_parameters() const { return kShared + 3 * number_of_radars; }
};

}  // namespace boresight::alignment
