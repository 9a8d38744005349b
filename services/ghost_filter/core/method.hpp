// What every method of telling false moving detections from real ones has in common.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/ghost_filter/core/config.hpp"
#include "services/ghost_filter/core/evidence/levels.hpp"

namespace boresight::ghosts {

class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// The tracks of the previous step. Without any, methods do what they can, and say so in the scan's flags.
  virtual void add_tracks(const TrackList& tracks) = 0;

  /// Writes everything of `out` but the header. Scans come in the order of their measurement, of all radars mixed.
  virtual void classify(const CorrectedScan& scan, ClassifiedScan& out) = 0;

  /// Points of the stationary world that are accumulated at present.
  [[nodiscard]] virtual std::size_t map_points() const = 0;

  /// The evidence of each moving detection of the last scan, to fit weights; empty if the method has none.
  [[nodiscard]] virtual std::span<const JudgedEvidence> evidence() const { return {}; }
};

/// The method that the configuration names; what it needs is allocated here, and never later.
[[nodiscard]] std::unique_ptr<Method> make_method(const Config& config);

}  // namespace boresight::ghosts
