#include "services/ingest_gateway/core/offset_envelope.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

constexpr double kBucket_ns = 1e9;
/// Largest drift of a sensor's quartz against that of the ECU.
constexpr double kMaxDrift = 100e-6;
/// Largest rate of change of the smoothed offset: five times the largest drift, 25 µs in a cycle of 50 ms.
constexpr double kMaxSlew = 500e-6;
/// Before this time the estimate is corrected at once, as it is only as good as the frame with the least delay.
constexpr double kSettling_ns = 2e9;
/// Over a shorter span, jitter would appear as drift.
constexpr double kSpanForSlope_ns = 10e9;

}  // namespace

void OffsetEnvelope::add(std::int64_t stamp_ns, std::int64_t offset_ns) {
  if (!anchored_) {
    anchored_ = true;
    anchor_stamp_ns_ = stamp_ns;
    anchor_offset_ns_ = offset_ns;
    return;
  }
  const double x = static_cast<double>(stamp_ns - anchor_stamp_ns_);
  const double y = static_cast<double>(offset_ns - anchor_offset_ns_);
  if (x - bucket_begin_ns_ >= kBucket_ns) {
    close_bucket();
    bucket_begin_ns_ = x;
    least_ = {x, y};
    fit_line();
  } else if (y < least_.y_ns) {
    least_ = {x, y};
  }
  intercept_ns_ -= std::max(0.0, line(x) - y);  // no frame arrives early
  const double step_ns = kMaxSlew * std::max(0.0, x - last_x_ns_);
  smoothed_ns_ = settled() ? std::clamp(line(x), smoothed_ns_ - step_ns, smoothed_ns_ + step_ns) : line(x);
  last_x_ns_ = x;
}

std::int64_t OffsetEnvelope::offset_ns() const {
  return anchor_offset_ns_ + std::llround(smoothed_ns_);
}

std::int64_t OffsetEnvelope::lateness_ns(std::int64_t stamp_ns, std::int64_t offset_ns) const {
  const double expected_ns = line(static_cast<double>(stamp_ns - anchor_stamp_ns_));
  return offset_ns - anchor_offset_ns_ - std::llround(expected_ns);
}

bool OffsetEnvelope::settled() const {
  return last_x_ns_ > kSettling_ns;
}

void OffsetEnvelope::close_bucket() {
  ring_[next_] = least_;
  next_ = (next_ + 1) % kBuckets;
  size_ = std::min(size_ + 1, kBuckets);
}

void OffsetEnvelope::fit_line() {
  slope_ = fit_slope();
  intercept_ns_ = least_.y_ns - slope_ * least_.x_ns;
  for (std::size_t i = 0; i < size_; ++i) {
    intercept_ns_ = std::min(intercept_ns_, ring_[i].y_ns - slope_ * ring_[i].x_ns);
  }
}

/// Fits the edge of the lower convex hull below the points' centre: of all lines below all points, it is the closest to
/// them on average.
double OffsetEnvelope::fit_slope() const {
  std::array<Point, kBuckets> hull;
  std::size_t corners = 0;
  double sum_ns = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    const Point p = ring_[(next_ + kBuckets - size_ + i) % kBuckets];
    sum_ns += p.x_ns;
    while (corners >= 2) {
      const Point& a = hull[corners - 2];
      const Point& b = hull[corners - 1];
      if ((b.y_ns - a.y_ns) * (p.x_ns - a.x_ns) < (p.y_ns - a.y_ns) * (b.x_ns - a.x_ns)) break;
      --corners;
    }
    hull[corners++] = p;
  }
  if (corners < 2 || hull[corners - 1].x_ns - hull[0].x_ns < kSpanForSlope_ns) return 0.0;
  const double centre_ns = sum_ns / static_cast<double>(size_);
  std::size_t right = 1;
  while (right + 1 < corners && hull[right].x_ns < centre_ns) ++right;
  const Point& a = hull[right - 1];
  const Point& b = hull[right];
  return std::clamp((b.y_ns - a.y_ns) / (b.x_ns - a.x_ns), -kMaxDrift, kMaxDrift);
}

}  // namespace boresight::ingest
