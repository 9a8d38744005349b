#include "services/ghost_filter/core/evidence/counts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::ghosts {

namespace {

/// Scans of the memory: 8 radars of 20 scans a second for 0.4 s.
constexpr std::size_t kMemories = 64;
/// Grid for finding earlier detections near a position. It covers 256 m and repeats: positions 256 m apart share a
/// cell, and the distance test tells them apart.
constexpr std::int32_t kCells = 64;  // in each direction
constexpr float kCell_m = 4.0F;

std::int32_t cell_index(float at_m) {
  return static_cast<std::int32_t>(std::floor(at_m * (1.0F / kCell_m)));
}

std::size_t cell_number(std::int32_t column, std::int32_t row) {
  return static_cast<std::size_t>((row & (kCells - 1)) * kCells + (column & (kCells - 1)));
}

std::size_t cell_of(const Eigen::Vector2f& position_m) {
  return cell_number(cell_index(position_m.x()), cell_index(position_m.y()));
}

float wrapped(float angle_rad) {
  constexpr auto kPi = static_cast<float>(M_PI);
  return angle_rad > kPi ? angle_rad - 2.0F * kPi : angle_rad < -kPi ? angle_rad + 2.0F * kPi : angle_rad;
}

}  // namespace

Counter::Counter(const CountConfig& config, std::uint32_t most_past_scans)
    : config_(config), most_past_scans_(most_past_scans), memories_(kMemories), cell_begin_(kCells * kCells + 1) {
  for (Memory& m : memories_) m.detections.reserve(kMaxDetections);
  moved_.reserve(config.most_remembered);
  by_cell_.resize(config.most_remembered);
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
    const Eigen::Vector2f velocity = c.range_rate_over_ground_mps * c.direction;
    m.detections.push_back({c.position_m, velocity, c.range_rate_over_ground_mps});
  }
}

void Counter::move(std::int64_t time_ns) {
  moved_.clear();
  for (std::size_t age = 0; age < size_; ++age) {
    const Memory& m = memory(age);
    const auto elapsed_s = static_cast<float>(static_cast<double>(time_ns - m.time_ns) * 1e-9);
    if (elapsed_s <= 0.0F) continue;
    for (const Remembered& r : m.detections) {
      if (moved_.size() == config_.most_remembered) break;
      moved_.push_back(
          {r.position_m + elapsed_s * r.velocity_mps, r.range_rate_over_ground_mps, static_cast<std::uint32_t>(age)});
    }
  }
  // A counting sort by cell.
  std::fill(cell_begin_.begin(), cell_begin_.end(), 0U);
  for (const Moved& m : moved_) ++cell_begin_[cell_of(m.position_m) + 1];
  std::partial_sum(cell_begin_.begin(), cell_begin_.end(), cell_begin_.begin());
  for (const Moved& m : moved_) by_cell_[cell_begin_[cell_of(m.position_m)]++] = m;
  // Each begin is that of the next cell now.
  std::copy_backward(cell_begin_.begin(), cell_begin_.end() - 1, cell_begin_.end());
  cell_begin_.front() = 0;
}

std::uint32_t Counter::past_scans(const Candidate& c) {
  const auto radius_m = static_cast<float>(config_.past_radius_m + config_.past_radius_per_range * c.range_m);
  const auto gate_mps = static_cast<float>(config_.past_range_rate_mps);
  const Eigen::Vector2f low = c.position_m.array() - radius_m, high = c.position_m.array() + radius_m;
  static_assert(kMemories <= 64);
  std::uint64_t scans = 0;  // a bit each
  std::size_t looks = 0;
  for (std::int32_t row = cell_index(low.y()); row <= cell_index(high.y()); ++row) {
    for (std::int32_t column = cell_index(low.x()); column <= cell_index(high.x()); ++column) {
      const std::size_t cell = cell_number(column, row);
      for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1] && looks < config_.most_past_looks; ++i) {
        const Moved& m = by_cell_[i];
        ++looks;
        if (std::abs(m.range_rate_over_ground_mps - c.range_rate_over_ground_mps) >= gate_mps) continue;
        if ((m.position_m - c.position_m).squaredNorm() < radius_m * radius_m) scans |= std::uint64_t{1} << m.age;
      }
    }
  }
  looks_ += looks;
  return std::min(most_past_scans_, static_cast<std::uint32_t>(std::popcount(scans)));
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
      if (has_above && looks < config_.most_neighbours) look(by_range_[above++]), ++looks;
    }
    looks_ += looks;
  }
}

void Counter::count(std::int64_t time_ns, std::span<const Candidate> scan, std::span<Counts> counts) {
  scan = scan.first(std::min({scan.size(), counts.size(), kMaxDetections}));
  forget(time_ns);
  count_scan(scan, counts);
  if (!scan.empty()) move(time_ns);
  for (std::size_t i = 0; i < scan.size(); ++i) counts[i].past_scans = past_scans(scan[i]);
  remember(time_ns, scan);
}

}  // namespace boresight::ghosts
