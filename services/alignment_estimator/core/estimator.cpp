#include "services/alignment_estimator/core/estimator.hpp"

#include <algorithm>

namespace boresight::alignment {

Estimator::Estimator(const VehicleConfig& vehicle, const Config& config) : config_(config) {
  radars_.reserve(vehicle.radars.size());
  for (const RadarConfig& radar : vehicle.radars) radars_.push_back({radar.id, Azimuth1d(radar, config), 0});
}

ScanResult Estimator::add_scan(const RadarScan& scan) {
  const auto entry =
      std::find_if(radars_.begin(), radars_.end(), [&](const Entry& e) { return e.id == scan.header.source_id; });
  if (entry == radars_.end()) return ScanResult::kUnknownRadar;
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  const EgoSample ego = ego_.at(time_ns);
  entry->method.process(scan, ego);
  const auto period_ns = static_cast<std::int64_t>(config_.publish_period_s * 1e9);
  // The measurement clock decides, so that a replay publishes the same estimates at any speed; a clock that went
  // back publishes at once.
  if (time_ns >= entry->next_publish_ns || time_ns < entry->next_publish_ns - 2 * period_ns) {
    entry->next_publish_ns = time_ns + period_ns;
    return ScanResult::kPublish;
  }
  return ego.valid && !ego.stale ? ScanResult::kUsed : ScanResult::kNoEgoMotion;
}

const Azimuth1d* Estimator::radar(std::uint32_t id) const {
  const auto entry = std::find_if(radars_.begin(), radars_.end(), [&](const Entry& e) { return e.id == id; });
  return entry == radars_.end() ? nullptr : &entry->method;
}

}  // namespace boresight::alignment
