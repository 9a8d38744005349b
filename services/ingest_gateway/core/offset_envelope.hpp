// How far one clock is behind another, from pairs of stamps of which one is late by a varying delay.
// Equations: docs/algorithms/ingest.md (I1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::ingest {

/// Lower envelope of reception − stamp over the last half minute: a frame can be delayed but never arrives early, so
/// the least differences lie on the line that the clocks' offset and drift draw, whatever the jitter of the others
/// (Moon, Skelly, Towsley: "Estimation and removal of clock skew from network delay measurements", 1999). What is told
/// follows that line slowly, so that neither jitter nor a better estimate shows in the spacing of mapped stamps.
class OffsetEnvelope {
 public:
  /// Forgets everything.
  void reset() { *this = {}; }

  /// `offset_ns` = reception − stamp. Stamps must not go back.
  void add(std::int64_t stamp_ns, std::int64_t offset_ns);

  [[nodiscard]] bool empty() const { return !anchored_; }
  /// The least offset to be expected at the stamp of the latest add(), smoothed. Not defined when empty.
  [[nodiscard]] std::int64_t offset_ns() const;
  /// By how much a frame of that stamp and offset is later (+) than the earliest to be expected.
  [[nodiscard]] std::int64_t lateness_ns(std::int64_t stamp_ns, std::int64_t offset_ns) const;
  /// Whether enough has been seen for the estimate to hold still.
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

  // Least offsets of a second each: 32 of them tell 100 ppm from nothing to a few ppm at some ms of jitter.
  static constexpr std::size_t kBuckets = 32;
  std::array<Point, kBuckets> ring_{};
  std::size_t size_ = 0, next_ = 0;
  bool anchored_ = false;
  std::int64_t anchor_stamp_ns_ = 0, anchor_offset_ns_ = 0;
  double bucket_begin_ns_ = 0.0;
  Point least_{};  // of the open bucket
  double intercept_ns_ = 0.0, slope_ = 0.0;
  double told_ns_ = 0.0, last_x_ns_ = 0.0;
};

}  // namespace boresight::ingest
