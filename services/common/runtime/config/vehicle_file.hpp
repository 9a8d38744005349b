// config/vehicle/*.toml → VehicleConfig.
#pragma once

#include <cstdint>
#include <filesystem>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::config {

/// Largest tolerance of a mounting error, and largest limit of use: larger ones would switch the verdict off.
inline constexpr double kMaxTolerance_deg = 5.0;
inline constexpr double kMaxLimit_deg = 30.0;

/// kOffline: for tables of detections instead of links; `ego`, `profile` and `source` are optional.
enum class VehicleUse : std::uint8_t { kLive, kOffline };

/// Reads the open document; throws Error with all problems (see config/schema/vehicle.md).
[[nodiscard]] VehicleConfig read_vehicle(Reader root, VehicleUse use = VehicleUse::kLive);
/// The same for a file at `file`, whose text is read from the open document: paths in it are relative to its folder.
[[nodiscard]] VehicleConfig read_vehicle_at(const std::filesystem::path& file, Reader root,
                                            VehicleUse use = VehicleUse::kLive);
[[nodiscard]] VehicleConfig read_vehicle_file(const std::filesystem::path& file, VehicleUse use = VehicleUse::kLive);

}  // namespace boresight::config
