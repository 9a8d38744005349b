#include "services/alignment_estimator/core/plausibility/copies.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace boresight::alignment::plausibility {

namespace {

/// Fewer detections can be equal by the resolution of their message.
constexpr std::size_t kLeastCompared = 4;
constexpr std::size_t kMostCompared = 64;
/// Scans beyond the others that make a finding, and the limit of the count: so many other scans withdraw it.
constexpr double kSufficientScans = 30.0, kMostScans = 45.0;
/// Of a scan that is not found among those of another radar.
constexpr double kOtherScan = 0.4;
constexpr std::size_t kMostFound = 8;
constexpr std::int64_t kFoundWithin_ns = 500'000'000;

bool equal(const ScanDetections& scan, std::size_t i, std::size_t j) {
  return scan.azimuth_rad[i] == scan.azimuth_rad[j] && scan.range_rate_mps[i] == scan.range_rate_mps[j] &&
         scan.range_m[i] == scan.range_m[j];
}

std::uint64_t mixed(std::uint64_t content, double value) {
  content = (content ^ std::bit_cast<std::uint64_t>(value)) * 0xff51afd7ed558ccdULL;
  return content ^ (content >> 32);
}

std::uint64_t values_of(const ScanDetections& scan, std::size_t i, std::uint64_t before) {
  return mixed(mixed(mixed(before, scan.azimuth_rad[i]), scan.range_rate_mps[i]), scan.range_m[i]);
}

void count(double& scans, bool is_so) {
  scans = std::clamp(scans + (is_so ? 1.0 : -1.0), 0.0, kMostScans);
}

}  // namespace

bool Copies::add(std::size_t index, const ScanDetections& scan, bool moves) {
  Radar& radar = radars_[index];
  const std::size_t compared = std::min(scan.count, kMostCompared);
  if (compared < kLeastCompared) return false;
  std::size_t copies = 0;
  for (std::size_t i = 1; i < compared; ++i) copies += equal(scan, i, 0) || equal(scan, i, i - 1) ? 1 : 0;
  std::uint64_t content = scan.count;
  for (std::size_t i = 0; i < std::min(scan.count, kMostFound); ++i) content = values_of(scan, i, content);
  const bool is_copy = 2 * copies >= compared || (moves && radar.content == content);
  radar.content = content;
  count(radar.copied, is_copy);
  if (!is_copy) compare(index, scan);
  return is_copy;
}

void Copies::compare(std::size_t index, const ScanDetections& scan) {
  std::size_t of_another = 0, other = index;
  const std::size_t compared = std::min(scan.count, kMostFound);
  for (std::size_t i = 0; i < compared; ++i) {
    const std::uint64_t values = values_of(scan, i, 1);
    Place& place = places_[values % places_.size()];
    if (place.values == values && place.radar != index && std::abs(place.time_ns - scan.time_ns) < kFoundWithin_ns) {
      ++of_another;
      other = place.radar;
    }
    place = {values, scan.time_ns, index};
  }
  Radar& radar = radars_[index];
  const bool is_same = 2 * of_another >= compared;
  // Only the later of two scans finds the other one, so that half of the scans suffice.
  if (is_same) {
    count(radar.same[other], true);
    count(radars_[other].same[index], true);
    return;
  }
  for (double& scans : radar.same) scans = std::max(0.0, scans - kOtherScan);
}

bool Copies::found(std::size_t radar) const {
  return radars_[radar].copied >= kSufficientScans;
}

bool Copies::same(std::size_t radar, std::size_t other) const {
  return radars_[radar].same[other] >= kSufficientScans / 2.0;
}

}  // namespace boresight::alignment::plausibility
