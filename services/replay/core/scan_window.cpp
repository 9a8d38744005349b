#include "services/replay/core/scan_window.hpp"

#include <algorithm>

namespace boresight::replay {

namespace {

// Lists that overtake their scan: at most one at a time. The others are of scans before the replay.
constexpr std::size_t kMaxEarly = 16;

}  // namespace

void ScanWindow::publish(const ScanId& scan, std::int64_t now_ns) {
  ++counts_[scan.radar].published;
  if (const auto early = std::find(early_.begin(), early_.end(), scan); early != early_.end()) {
    early_.erase(early);
    ++counts_[scan.radar].returned;
    return;
  }
  if (in_flight_.empty()) waiting_since_ns_ = now_ns;
  in_flight_.push_back(scan);
}

void ScanWindow::take_back(const ScanId& scan, std::int64_t now_ns) {
  waiting_since_ns_ = now_ns;
  answered_ = true;
  silent_ = false;
  const auto found = std::find(in_flight_.begin(), in_flight_.end(), scan);
  if (found == in_flight_.end()) {
    early_.push_back(scan);
    if (early_.size() > kMaxEarly) early_.pop_front();
    return;
  }
  const auto is_of_radar = [&scan](const ScanId& other) { return other.radar == scan.radar; };
  const auto kept = std::remove_if(in_flight_.begin(), found, is_of_radar);
  counts_[scan.radar].missing += static_cast<std::uint64_t>(found - kept);
  ++counts_[scan.radar].returned;
  in_flight_.erase(kept, found + 1);
}

void ScanWindow::expire(std::int64_t now_ns) {
  if (in_flight_.empty() || now_ns - waiting_since_ns_ < timeout_ns_) return;
  for (const ScanId& scan : in_flight_) ++counts_[scan.radar].missing;
  in_flight_.clear();
  silent_ = true;
}

void ScanWindow::begin_wait() {
  if (!in_flight_.empty()) ++counts_[in_flight_.front().radar].waits;
}

std::uint64_t ScanWindow::missing() const {
  std::uint64_t sum = 0;
  for (const auto& [radar, counts] : counts_) sum += counts.missing;
  return sum;
}

}  // namespace boresight::replay
