// All radars of the vehicle, each with its estimator, fed in the order of the messages.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/alignment_estimator/core/azimuth_1d.hpp"
#include "services/alignment_estimator/core/config.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// What came of a scan.
enum class ScanResult : std::uint8_t {
  kUsed,          ///< processed; nothing to publish yet
  kPublish,       ///< processed, and the radar's estimate is due
  kUnknownRadar,  ///< the vehicle file does not know this radar
  kNoEgoMotion,   ///< waiting: no ego motion at the time of the scan
};

class Estimator {
 public:
  Estimator(const VehicleConfig& vehicle, const Config& config);

  void add_ego_motion(const EgoMotion& motion) { ego_.add(motion); }
  [[nodiscard]] ScanResult add_scan(const RadarScan& scan);
  /// The estimate of one radar; nullptr for an unknown one.
  [[nodiscard]] const Azimuth1d* radar(std::uint32_t id) const;

 private:
  struct Entry {
    std::uint32_t id;
    Azimuth1d method;
    std::int64_t next_publish_ns;
  };
  Config config_;
  EgoHistory ego_;
  std::vector<Entry> radars_;
};

}  // namespace boresight::alignment
