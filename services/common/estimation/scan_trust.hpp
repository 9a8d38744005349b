// Whether a scan as a whole may be believed.
#pragma once

#include "interfaces/messages/radar_scan.hpp"

namespace boresight {

/// True if the gateway found that the scan is no new measurement, or contradicts the vehicle's motion.
[[nodiscard]] inline bool is_scan_wrong(const RadarScan& scan) {
  using namespace scan_integrity;
  return (scan.integrity & (kRepeated | kFrozen | kContradictsEgo | kImpossibleCopies)) != 0;
}

}  // namespace boresight
