// Scans that consist of copies of one detection, scans that repeat the previous one, and scans of another radar.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/alignment_estimator/core/scan_detections.hpp"

namespace boresight::alignment::plausibility {

class Copies {
 public:
  explicit Copies(std::size_t radars) : radars_(radars) {}

  /// Judges a scan; true: it consists of copies. `moves`: the vehicle moves, so that no scan can repeat another.
  [[nodiscard]] bool add(std::size_t radar, const ScanDetections& scan, bool moves);
  /// Most scans of this radar are copies.
  [[nodiscard]] bool found(std::size_t radar) const;
  /// The two radars send the same detections.
  [[nodiscard]] bool same(std::size_t radar, std::size_t other) const;

 private:
  static constexpr std::size_t kPlaces = 4096;
  struct Radar {
    double copied = 0.0;                    ///< scans of copies − other scans, limited
    std::uint64_t content = 0;              ///< of the previous scan
    std::array<double, kMaxRadars> same{};  ///< scans with detections of that radar − others, limited
  };
  /// A detection of the last half second, found by its values.
  struct Place {
    std::uint64_t values = 0;
    std::int64_t time_ns = 0;
    std::size_t radar = 0;
  };
  void compare(std::size_t radar, const ScanDetections& scan);
  std::vector<Radar> radars_;
  std::vector<Place> places_ = std::vector<Place>(kPlaces);
};

}  // namespace boresight::alignment::plausibility
