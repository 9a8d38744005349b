#include "services/ingest_gateway/codecs/toyota_radar.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace toyota_layout = wire::toyota;

namespace {

// Time-out within a cycle. Its frames arrive within some 10 ms; a cycle takes 50 ms.
constexpr std::int64_t kPauseBetweenCycles_ns = 20'000'000;
constexpr std::uint32_t kAllTracks = (1u << toyota_layout::kNumberOfTracks) - 1;

}  // namespace

void ToyotaRadar::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  const std::uint32_t id = frame.can_id;
  const std::span<const std::uint8_t> payload = frame.payload;
  const bool is_a = id >= toyota_layout::kTrackA && id < toyota_layout::kTrackA + toyota_layout::kNumberOfTracks;
  const bool is_b = id >= toyota_layout::kTrackB && id < toyota_layout::kTrackB + toyota_layout::kNumberOfTracks;
  if ((!is_a && !is_b) || frame.can_extended) return;
  if (payload.size() < (is_a ? toyota_layout::kTrackABytes : toyota_layout::kTrackBMinBytes) || payload.size() > 8) {
    output.fault(Fault::kWireLength,
                 is_a ? "Toyota TRACK_A: frame is not 8 bytes long" : "Toyota TRACK_B: frame is not 6 … 8 bytes long");
    return;
  }
  if (toyota_layout::checksum(id, payload) != payload.back()) {
    output.fault(Fault::kWireValue,
                 is_a ? "Toyota TRACK_A: checksum does not match" : "Toyota TRACK_B: checksum does not match");
    return;
  }
  const std::uint32_t slot = id - (is_a ? toyota_layout::kTrackA : toyota_layout::kTrackB);
  const std::uint32_t bit = 1u << slot;
  // A repeated frame, or one after a pause, belongs to the next cycle; the current one remains incomplete. The order of
  // frames within a cycle is not used: A and B frames of recorded cycles mix in any order.
  const bool came_before = ((is_a ? seen_a_ : seen_b_) & bit) != 0;
  if (came_before || (frames_ > 0 && stamp.received_ns - last_ns_ > kPauseBetweenCycles_ns)) finish(output);
  last_ns_ = stamp.received_ns;
  if (frames_++ == 0) {
    first_ = stamp;
    counter_ = static_cast<std::uint32_t>(wire::extract_raw(toyota_layout::kCounter, payload));
  }
  Slot& track = slots_[slot];
  if (is_a) {
    seen_a_ |= bit;
    track.valid = wire::extract_raw(toyota_layout::kValid, payload) != 0;
    track.longitudinal_m = wire::extract(toyota_layout::kLongitudinalDistance_m, payload);
    track.lateral_m = -wire::extract(toyota_layout::kLateralDistance_m, payload);
    track.relative_speed_mps = wire::extract(toyota_layout::kRelativeSpeed_mps, payload);
  } else {
    seen_b_ |= bit;
    track.has_score = true;
    track.score_percent = wire::extract(toyota_layout::kScore_percent, payload);
  }
  if (seen_a_ == kAllTracks && seen_b_ == kAllTracks) finish(output);
}

void ToyotaRadar::tick(std::int64_t now_ns, DecoderOutput& output) {
  if (frames_ > 0 && now_ns - last_ns_ > kPauseBetweenCycles_ns) finish(output);
}

void ToyotaRadar::finish(DecoderOutput& output) {
  const bool complete = frames_ == 2 * toyota_layout::kNumberOfTracks;
  if (!complete) output.fault(Fault::kWireLength, "Toyota radar: frames of a cycle are missing");
  if (RadarScan* const scan = output.begin_scan()) {
    write_scan(*scan);
    scan->integrity = complete ? 0 : scan_integrity::kIncomplete;
    output.publish_scan(first_, std::nullopt, 8);
  }
  slots_ = {};
  frames_ = seen_a_ = seen_b_ = 0;
}

void ToyotaRadar::write_scan(RadarScan& scan) const {
  std::uint32_t count = 0;
  for (const Slot& track : slots_) {
    if (!track.valid) continue;
    scan.range_m[count] = static_cast<float>(std::hypot(track.longitudinal_m, track.lateral_m));
    scan.azimuth_rad[count] = static_cast<float>(std::atan2(track.lateral_m, track.longitudinal_m));
    scan.elevation_rad[count] = 0.0F;
    scan.range_rate_mps[count] = static_cast<float>(track.relative_speed_mps);
    scan.rcs_dbsm[count] = scan.snr_db[count] = 0.0F;
    scan.range_std_m[count] = scan.azimuth_std_rad[count] = 0.0F;
    scan.elevation_std_rad[count] = scan.range_rate_std_mps[count] = 0.0F;
    scan.existence_probability[count] =
        track.has_score ? static_cast<float>(std::clamp(track.score_percent * 0.01, 0.0, 1.0)) : 0.0F;
    scan.detection_flags[count] = 0;
    ++count;
  }
  scan.cycle_counter = counter_;
  scan.number_of_valid_detections = count;
  scan.dropped_detections = 0;
  scan.fields = scan_field::kExistence;
  scan.range_rate_min_mps = scan.range_rate_max_mps = 0.0F;
}

}  // namespace boresight::ingest
