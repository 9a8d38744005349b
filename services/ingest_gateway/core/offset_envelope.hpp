// Estimates the offset between two clocks from pairs of stamps, one of which has a varying delay.
// Equations: docs/algorithms/ingest.md (I1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::ingest {

/// Lower envelope of reception − stamp over the last half minute: a frame can be delayed but never arrives early, so
/// the least differences lie on the line of the clocks' offset and drift, whatever the jitter of the others (Moon,
/// Skelly and Towsley 1999). The reported offset follows this line slowly, so that neither jitter nor a better estimate
/// affects the spacing of converted stamps.
class OffsetEnvelope {
 public:
  /// Deletes all data.
  void reset() { *this = {}; }

  /// `offset_ns` = reception − stamp. Stamps must not go back.
  void add(std::int64_t stamp_ns, std::int64_t offset_ns);

  [[nodiscard]] bool empty() const { return !anchored_; }
  /// The least offset to be expected at the stamp of the latest add(), smoothed. Not defined when empty.
  [[nodiscard]] std::int64_t offset_ns() const;
  /// Delay (+) of a frame with that stamp and offset beyond the least one to be expected.
  [[nodiscard]] std::int64_t lateness_ns(std::int64_t stamp_ns, std::int64_t offset_ns) const;
  /// True if the data are sufficient for a stable estimate.
  [[nodiscard]] bool settled() const;

 private:
  struct Point {
    double x_ns;  // stamp since the anchor
    double y_ns;  // offset above the anchor's
  };
  [[nodiscard]] double line(double x_ns) const { return intercept_ns_ + slope_ * x_ns; }
  void close_bucket();
  void fit_line();
  [[nodiscard]] double fit_slope() const;

  // Least offset of each second: 32 of them give the drift to a few ppm at some ms of jitter.
  static constexpr std::size_t kBuckets = 32;
  std::array<Point, kBuckets> ring_{};
  std::size_t size_ = 0, next_ = 0;
  bool anchored_ = false;
  std::int64_t anchor_stamp_ns_ = 0, anchor_offset_ns_ = 0;
  double bucket_begin_ns_ = 0.0;
  Point least_{};  // of the current second
  double intercept_ns_ = 0.0, slope_ = 0.0;
  double smoothed_ns_ = 0.0, last_x_ns_ = 0.0;
};

}  // namespace boresight::ingest
