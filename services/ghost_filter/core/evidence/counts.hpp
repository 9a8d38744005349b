// What a scan and the scans before it show of a moving detection, as six counts. None depends on the strength.
//
// An object is detected again where it was before, moved by its range rate; most false moving detections last one scan.
// An object has several detections at one place; an echo that is smeared over azimuth, or a side lobe, has several at
// one range and range rate but at different azimuths. Bursts of false detections fill a scan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/evidence/config.hpp"

namespace boresight::ghosts {

/// A moving detection as the counts need it.
struct Candidate {
  float range_m;
  float azimuth_rad;
  float range_rate_mps;  ///< as measured, not compensated
  float range_rate_over_ground_mps;
  Eigen::Vector2f position_m;  ///< in a frame that does not move
  Eigen::Vector2f direction;   ///< of the line of sight in that frame, unit
};

struct Counts {
  std::uint32_t past_scans = 0;  ///< earlier scans, of any radar, with a detection where this one would have been
  std::uint32_t company = 1;     ///< detections of this scan beside it, itself included
  std::uint32_t ring = 0;        ///< others of its range and range rate, at other azimuths
  std::uint32_t wide_ring = 0;   ///< others of nearly its range and range rate, at other azimuths, beyond `ring`
  std::uint32_t moving = 0;      ///< moving detections of this scan
  float range_m = 0.0F;
};

/// Remembers the moving detections of the last scans. Allocates nothing after construction. The work per candidate is
/// bounded by the configuration.
class Counter {
 public:
  /// `most_past_scans`: past_scans stops there.
  explicit Counter(const CountConfig& config,
                   std::uint32_t most_past_scans = std::numeric_limits<std::uint32_t>::max());

  /// Counts of each candidate of a scan, in their order, then remembers them. Candidates beyond the capacity of a scan
  /// get no counts. Scans come in the order of measurement, up to some milliseconds.
  void count(std::int64_t time_ns, std::span<const Candidate> scan, std::span<Counts> counts);
  /// Forgets the earlier scans: the frame has changed.
  void clear() { first_ = size_ = 0; }
  /// Pairs compared since construction: the measure of the work.
  [[nodiscard]] std::uint64_t looks() const { return looks_; }

 private:
  struct Remembered {
    Eigen::Vector2f position_m, velocity_mps;
    float range_rate_over_ground_mps;
  };
  struct Memory {
    std::int64_t time_ns = 0;
    std::vector<Remembered> detections;
  };
  /// A remembered detection where it would be now.
  struct Moved {
    Eigen::Vector2f position_m;
    float range_rate_over_ground_mps;
    std::uint16_t age;  // scans that were remembered later
    std::uint16_t cell;
  };
  void forget(std::int64_t time_ns);
  void remember(std::int64_t time_ns, std::span<const Candidate> scan);
  void move(std::int64_t time_ns);
  void count_scan(std::span<const Candidate> scan, std::span<Counts> counts);
  /// Counts of the candidate at `own` by the others from `begin` to `end`, in the order of range.
  [[nodiscard]] Counts compare(std::size_t own, std::size_t begin, std::size_t end) const;
  [[nodiscard]] std::uint32_t past_scans(const Candidate& c);
  [[nodiscard]] Memory& memory(std::size_t age) { return memories_[(first_ + size_ - 1 - age) % memories_.size()]; }

  CountConfig config_;
  std::uint32_t most_past_scans_;
  std::vector<Memory> memories_;  // a ring
  std::size_t first_ = 0, size_ = 0;
  std::vector<Moved> moved_, by_cell_;  // newest first, in the latter within each cell
  std::vector<std::uint32_t> cell_begin_;
  std::vector<std::uint32_t> order_;                           // of the scan's candidates, by range
  std::vector<float> range_m_, azimuth_rad_, range_rate_mps_;  // in that order
  std::uint64_t looks_ = 0;
};

}  // namespace boresight::ghosts
