// Identity of what is kept over a restart: the vehicle and the radars that it is valid for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/header.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight {

/// Fingerprints (CRC-64) of the vehicle's name and of each radar's nominal mounting and profile.
struct Identity {
  struct Radar {
    std::uint32_t id = 0;
    std::uint64_t fingerprint = 0;
  };
  std::uint64_t vehicle = 0;
  std::size_t number_of_radars = 0;
  std::array<Radar, kMaxRadars> radars{};

  /// The fingerprint of that radar, or nullptr.
  [[nodiscard]] const std::uint64_t* fingerprint(std::uint32_t id) const {
    for (std::size_t i = 0; i < number_of_radars; ++i) {
      if (radars[i].id == id) return &radars[i].fingerprint;
    }
    return nullptr;
  }
};

[[nodiscard]] Identity identity_of(const VehicleConfig& vehicle);

}  // namespace boresight
