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

/// Rounds down; faster than std::floor without an instruction for it.
std::int32_t cell_index(float at_m) {
  const float cells = at_m * (1.0F / kCell_m);
  const auto towards_zero = static_cast<std::int32_t>(cells);
  return towards_zero - (static_cast<float>(towards_zero) > cells ? 1 : 0);
}

std::uint16_t cell_number(std::int32_t column, std::int32_t row) {
  return static_cast<std::uint16_t>((row & (kCells - 1)) * kCells + (column & (kCells - 1)));
}

std::uint16_t cell_of(const Eigen::Vector2f& position_m) {
  return cell_number(cell_index(position_m.x()), cell_index(position_m.y()));
}

}  // namespace

Counter::Counter(const CountConfig& config, std::uint32_t most_past_scans)
    : config_(config), most_past_scans_(most_past_scans), memories_(kMemories), cell_begin_(kCells * kCells + 1) {
  for (Memory& m : memories_) m.detections.reserve(kMaxDetections);
  moved_.reserve(config.most_remembered);
  by_cell_.resize(config.most_remembered);
  order_.reserve(kMaxDetections);
  for (std::vector<float>* const column : {&range_m_, &azimuth_rad_, &range_rate_mps_}) column->resize(kMaxDetections);
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
      const Eigen::Vector2f position = r.position_m + elapsed_s * r.velocity_mps;
      moved_.push_back({position, r.range_rate_over_ground_mps, static_cast<std::uint16_t>(age), cell_of(position)});
    }
  }
  // A counting sort by cell.
  std::fill(cell_begin_.begin(), cell_begin_.end(), 0U);
  for (const Moved& m : moved_) ++cell_begin_[m.cell + 1U];
  std::partial_sum(cell_begin_.begin(), cell_begin_.end(), cell_begin_.begin());
  for (const Moved& m : moved_) by_cell_[cell_begin_[m.cell]++] = m;
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
  const std::size_t count = scan.size();
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return scan[a].range_m < scan[b].range_m; });
  for (std::size_t k = 0; k < count; ++k) {
    const Candidate& c = scan[order_[k]];
    range_m_[k] = c.range_m;
    azimuth_rad_[k] = c.azimuth_rad;
    range_rate_mps_[k] = c.range_rate_mps;
  }
  const auto wide_m = static_cast<float>(config_.wide_range_m);
  std::size_t first = 0, last = 0;  // candidates within the wide range
  for (std::size_t k = 0; k < count; ++k) {
    while (range_m_[k] - range_m_[first] >= wide_m) ++first;
    while (last < count && range_m_[last] - range_m_[k] < wide_m) ++last;
    // The nearest by rank: half of them on either side, or more where the other side has fewer.
    const std::size_t most = config_.most_neighbours, all_below = k - first, all_above = last - k - 1;
    const std::size_t below = std::min(all_below, std::max((most + 1) / 2, most - std::min(most, all_above)));
    const std::size_t above = std::min(all_above, most - below);
    looks_ += below + above;
    Counts& out = counts[order_[k]];
    out = compare(k, k - below, k + above + 1);
    out.moving = static_cast<std::uint32_t>(count);
  }
}

/// Without branches, so that the compiler compares several at once.
Counts Counter::compare(std::size_t own, std::size_t begin, std::size_t end) const {
  const float range_m = range_m_[own], azimuth_rad = azimuth_rad_[own], range_rate_mps = range_rate_mps_[own];
  const auto near_m = static_cast<float>(config_.company_radius_m);
  const auto near_mps = static_cast<float>(config_.company_range_rate_mps);
  const auto wide_mps = static_cast<float>(config_.wide_range_rate_mps);
  std::uint32_t company = 0, ring = 0, wide_ring = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const float rates = std::abs(range_rate_mps_[i] - range_rate_mps), turn = std::abs(azimuth_rad_[i] - azimuth_rad);
    const float across = std::min(turn, 2.0F * static_cast<float>(M_PI) - turn) * range_m;
    const unsigned is_wide = rates < wide_mps, is_beside = across < near_m;
    const unsigned is_near = is_wide & (rates < near_mps) & (std::abs(range_m_[i] - range_m) < near_m);
    company += is_near & is_beside;
    ring += is_near & ~is_beside & 1U;
    wide_ring += is_wide & ~is_near & ~is_beside & 1U;
  }
  Counts counts;
  counts.company = company;
  counts.ring = ring;
  counts.wide_ring = wide_ring;
  counts.range_m = range_m;
  return counts;
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
