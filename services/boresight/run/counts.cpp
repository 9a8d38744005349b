#include "services/boresight/run/counts.hpp"

#include <algorithm>

namespace boresight::run {

Rejection rejection_of(std::uint16_t flags) {
  if ((flags & corrected_flag::kInvalid) != 0) return Rejection::kInvalid;
  if ((flags & corrected_flag::kOutsideRegion) != 0) return Rejection::kOutsideRegion;
  return (flags & corrected_flag::kWeak) != 0 ? Rejection::kWeak : Rejection::kNone;
}

void add(const ScanResult& result, Counts& counts) {
  RadarCounts& radar = counts.radars[std::min<std::size_t>(result.scan.header.source_id, kMaxRadars)];
  const std::size_t detections = result.classified.number_of_valid_detections;
  radar.detections += detections;
  radar.dropped_detections += result.scan.dropped_detections;
  counts.tracks += result.tracks.number_of_tracks;
  for (std::size_t bit = 0; bit < radar.integrity.size(); ++bit) {
    radar.integrity[bit] += static_cast<std::uint64_t>(result.scan.integrity >> bit & 1);
  }
  for (std::size_t bit = 0; bit < radar.flags.size(); ++bit) radar.flags[bit] += result.classified.flags >> bit & 1u;
  for (std::size_t i = 0; i < detections; ++i) {
    const Rejection rejection = rejection_of(result.classified.detection_flags[i]);
    if (rejection != Rejection::kNone) {
      ++radar.rejections[static_cast<std::size_t>(rejection)];
    } else {
      ++radar.origins[std::min(static_cast<std::size_t>(result.classified.provenance[i]), kNumberOfProvenances - 1)];
    }
  }
}

std::uint64_t scans_without_ego_motion(const Counts& counts) {
  constexpr std::size_t kNoEgoMotionBit = 2, kEgoMotionStaleBit = 3;
  static_assert(pipeline_flag::kNoEgoMotion == 1u << kNoEgoMotionBit);
  static_assert(pipeline_flag::kEgoMotionStale == 1u << kEgoMotionStaleBit);
  std::uint64_t scans = 0;
  for (const RadarCounts& radar : counts.radars) {
    scans += radar.flags.at(kNoEgoMotionBit) + radar.flags.at(kEgoMotionStaleBit);
  }
  return scans;
}

}  // namespace boresight::run
