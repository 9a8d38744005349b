// Sensor frame → vehicle frame, with mounting error and ego motion removed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/estimation/unknown_elevation.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/config.hpp"
#include "services/detection_corrector/core/mounting.hpp"
#include "services/detection_corrector/core/range_rate_noise.hpp"

namespace boresight::corrector {

/// Keeps the latest side inputs and corrects scans with them. No allocation after construction.
class Corrector {
 public:
  Corrector(const VehicleConfig& vehicle, const Config& config);

  /// Returns false and ignores the estimate if the radar is unknown.
  bool add_alignment(const AlignmentEstimate& estimate);
  void add_ego_motion(const EgoMotion& motion) { ego_.add(motion); }

  /// Whether the radar is in the vehicle file, as correct() requires.
  [[nodiscard]] bool knows(std::uint32_t radar_id) const { return vehicle_.radar(radar_id) != nullptr; }

  /// Writes everything of `out` except the header. `out.flags` names missing side inputs. All detections of a scan that
  /// is proven wrong are invalid. A scan of an unknown radar gives an empty output. Learns the radar's range-rate noise
  /// from the scan, for the scans after it.
  void correct(const RadarScan& scan, CorrectedScan& out);

  /// Learnt ratio of actual to stated std of a radar's range rates; 1 for an unknown radar.
  [[nodiscard]] double range_rate_noise_scale(std::uint32_t radar_id) const;

 private:
  /// Of a radar of the vehicle, in its list.
  [[nodiscard]] std::size_t index_of(std::uint32_t radar_id) const;

  struct Latest {
    bool present = false;
    AlignmentEstimate estimate;
  };
  VehicleConfig vehicle_;
  Config config_;
  EgoHistory ego_;
  std::vector<UnknownElevation> unknown_elevations_;  // one per radar of the vehicle, in their order
  std::vector<RangeRateNoise> noises_;                // likewise
  std::array<Latest, kMaxRadars + 1> alignment_{};
  std::array<Innovation, kMaxDetections> innovations_{};  // of the scan, as far as the radar states its noise
};

}  // namespace boresight::corrector
