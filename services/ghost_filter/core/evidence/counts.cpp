#include "services/ghost_filter/core/evidence/counts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::ghosts {

namespace {

/// Scans of the memory: 8 radars of 20 scans a second for 0.4 s.
constexpr std::size_t kMemories = 64;

float wrapped(float angle_rad) {
  constexpr auto kPi = static_cast<float>(M_PI);
  return angle_rad > kPi ? angle_rad - 2.0F * kPi : angle_rad < -kPi ? angle_rad + 2.0F * kPi : angle_rad;
}

}  // namespace

Counter::Counter(const CountConfig& config, std::uint32_t most_past_scans)
    : config_(config), most_past_scans_(most_past_scans), memories_(kMemories) {
  for (Memory& m : memories_) m.detections.reserve(kMaxDetections);
  order_.reserve(kMaxDetections);
  by_range_.reserve(kMaxDetections);
}

void Counter::forget(std::int64_t time_ns) {
  const auto keep_ns = static_cast<std::int64_t>(config_.memory_s * 1e9);
  while (size_ > 0 && time_ns - memories_[first_].time_ns >= keep_ns) {
    first_ = (first_ + 1) % memories_.size();
    --size_;
  }
}

void Counter::remember(std::int64_t time_ns, std::span<const Candidate> scan) {
  if (size_ == memories_.size()) {
    first_ = (first_ + 1) % memories_.size();
    --size_;
  }
  ++size_;
  Memory& m = memory(0);
  m.time_ns = time_ns;
  m.detections.clear();
  for (const Candidate& c : scan) {
    m.detections.push_back({c.position_m.x(), c.position_m.y(), c.range_rate_over_ground_mps});
  }
  std::sort(m.detections.begin(), m.detections.end(),
            [](const Remembered& a, const Remembered& b) { return a.x_m < b.x_m; });
}

std::uint32_t Counter::past_scans(std::int64_t time_ns, const Candidate& c) {
  const auto radius_m = static_cast<float>(config_.past_radius_m + config_.past_radius_per_range * c.range_m);
  const auto gate_mps = static_cast<float>(config_.past_range_rate_mps);
  const Eigen::Vector2f velocity = c.range_rate_over_ground_mps * c.direction;
  std::uint32_t scans = 0;
  std::size_t looks = 0;
  for (std::size_t age = 0; age < size_ && scans < most_past_scans_ && looks < config_.most_past_looks; ++age) {
    const Memory& m = memory(age);
    const auto elapsed_s = static_cast<float>(static_cast<double>(time_ns - m.time_ns) * 1e-9);
    if (elapsed_s <= 0.0F) continue;
    const Eigen::Vector2f before = c.position_m - elapsed_s * velocity;
    auto at = std::lower_bound(m.detections.begin(), m.detections.end(), before.x() - radius_m,
                               [](const Remembered& r, float x) { return r.x_m < x; });
    for (; at != m.detections.end() && at->x_m <= before.x() + radius_m && looks < config_.most_past_looks; ++at) {
      ++looks;
      if (std::abs(at->range_rate_over_ground_mps - c.range_rate_over_ground_mps) >= gate_mps) continue;
      const float dx = at->x_m - before.x(), dy = at->y_m - before.y();
      if (dx * dx + dy * dy >= radius_m * radius_m) continue;
      ++scans;
      break;
    }
  }
  looks_ += looks;
  return scans;
}

void Counter::count_scan(std::span<const Candidate> scan, std::span<Counts> counts) {
  order_.resize(scan.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return scan[a].range_m < scan[b].range_m; });
  by_range_.clear();
  for (const std::uint32_t i : order_) by_range_.push_back(scan[i]);
  const auto wide_m = static_cast<float>(config_.wide_range_m);
  const auto wide_mps = static_cast<float>(config_.wide_range_rate_mps);
  const auto near_m = static_cast<float>(config_.company_radius_m);
  const auto near_mps = static_cast<float>(config_.company_range_rate_mps);
  for (std::size_t k = 0; k < by_range_.size(); ++k) {
    const Candidate& c = by_range_[k];
    Counts& out = counts[order_[k]];
    out = Counts{};
    out.moving = static_cast<std::uint32_t>(scan.size());
    out.range_m = c.range_m;
    const auto look = [&](const Candidate& other) {
      const float rates = std::abs(other.range_rate_mps - c.range_rate_mps);
      if (rates >= wide_mps) return;
      const float ranges = std::abs(other.range_m - c.range_m);
      const bool is_near = ranges < near_m && rates < near_mps;
      const float across = std::abs(wrapped(other.azimuth_rad - c.azimuth_rad)) * c.range_m;
      if (across < near_m) {
        out.company += is_near ? 1 : 0;
      } else if (is_near) {
        ++out.ring;
      } else {
        ++out.wide_ring;
      }
    };
    // Outwards in range, to either side in turn.
    std::size_t below = k, above = k + 1, looks = 0;
    while (looks < config_.most_neighbours) {
      const bool has_below = below > 0 && c.range_m - by_range_[below - 1].range_m < wide_m;
      const bool has_above = above < by_range_.size() && by_range_[above].range_m - c.range_m < wide_m;
      if (!has_below && !has_above) break;
      if (has_below) look(by_range_[--below]), ++looks;
      if (has_above) look(by_range_[above++]), ++looks;
    }
    looks_ += looks;
  }
}

void Counter::count(std::int64_t time_ns, std::span<const Candidate> scan, std::span<Counts> counts) {
  scan = scan.first(std::min({scan.size(), counts.size(), kMaxDetections}));
  forget(time_ns);
  count_scan(scan, counts);
  for (std::size_t i = 0; i < scan.size(); ++i) counts[i].past_scans = past_scans(time_ns, scan[i]);
  remember(time_ns, scan);
}

}  // namespace boresight::ghosts
