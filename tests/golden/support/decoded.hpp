// Decodes a recording by the gateway's core, in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::golden {

/// One message, in the order of publication: exactly one of the two is set. Measurement times are those of the
/// recording's clock.
struct Decoded {
  std::unique_ptr<RadarScan> scan;
  std::unique_ptr<EgoMotion> ego;
};

struct Decoding {
  std::vector<Decoded> messages;
  std::vector<std::string> faults;
};

/// The vehicle file of that name in config/vehicle.
[[nodiscard]] VehicleConfig vehicle(const std::string& name);
[[nodiscard]] Decoding decode(const VehicleConfig& vehicle, const std::filesystem::path& recording);

/// Folder of the recordings, and whether a recording exists.
[[nodiscard]] std::filesystem::path shared_data();

}  // namespace boresight::golden

/// Skips the test where the shared data is absent.
#define REQUIRE_RECORDING(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: no shared data"
