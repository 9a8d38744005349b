#include "services/ingest_gateway/codecs/ars408.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/ingest_gateway/codecs/report.hpp"

namespace boresight::ingest {

namespace ars408_layout = wire::ars408;
using Payload = std::span<const std::uint8_t>;

namespace {

// Time-out within a cycle. Its frames are sent at the speed of the bus; cycles are some 70 ms apart.
constexpr std::int64_t kArs408Silence_ns = 30'000'000;

std::size_t raw(const wire::CanSignal& signal, Payload payload) {
  return static_cast<std::size_t>(wire::extract_raw(signal, payload));
}

/// Variance of a value that is rounded to steps of that size: uniform over a step.
double rounding_variance(const wire::CanSignal& signal) {
  return signal.factor * signal.factor / 12.0;
}

/// Variance of a quantity from the code of its standard deviation and its rounding step. False if the sensor states
/// none.
bool variance_of(const wire::CanSignal& code, Payload quality, const wire::CanSignal& quantity, double& variance) {
  const std::size_t index = raw(code, quality);
  if (index >= ars408_layout::kRms.size()) return false;
  variance = ars408_layout::kRms[index] * ars408_layout::kRms[index] + rounding_variance(quantity);
  return true;
}

/// Middle of the interval of a probability code; `unknown` for the code "invalid".
double probability_of(std::size_t code, double unknown) {
  return code == 0 ? unknown : 0.5 * (ars408_layout::kProbability[code - 1] + ars408_layout::kProbability[code]);
}

bool has_bit(std::uint32_t mask, std::size_t bit) {
  return bit < 32 && (mask >> bit & 1u) != 0;
}

struct FrameKind {
  std::uint32_t id;
  std::size_t bytes;
  const char* name;
};
constexpr FrameKind kState{ars408_layout::kStateId, ars408_layout::kStateBytes, "state"};
constexpr FrameKind kClusterStatus{ars408_layout::kClusterStatusId, ars408_layout::kClusterStatusBytes,
                                   "cluster status"};
constexpr FrameKind kClusterGeneral{ars408_layout::kClusterGeneralId, ars408_layout::kClusterGeneralBytes,
                                    "cluster general"};
constexpr FrameKind kClusterQuality{ars408_layout::kClusterQualityId, ars408_layout::kClusterQualityBytes,
                                    "cluster quality"};
constexpr FrameKind kObjectStatus{ars408_layout::kObjectStatusId, ars408_layout::kObjectStatusBytes, "object status"};
constexpr FrameKind kObjectGeneral{ars408_layout::kObjectGeneralId, ars408_layout::kObjectGeneralBytes,
                                   "object general"};
constexpr FrameKind kObjectQuality{ars408_layout::kObjectQualityId, ars408_layout::kObjectQualityBytes,
                                   "object quality"};
constexpr std::array<const FrameKind*, 7> kFrames{&kState,        &kClusterStatus, &kClusterGeneral, &kClusterQuality,
                                                  &kObjectStatus, &kObjectGeneral, &kObjectQuality};

std::uint32_t conditions_of(Payload state) {
  std::uint32_t conditions = 0;
  const auto judge = [&](const wire::CanSignal& signal, std::uint32_t condition) {
    if (raw(signal, state) != 0) conditions |= condition;
  };
  judge(ars408_layout::state::kPersistentError, source_condition::kDefective);
  judge(ars408_layout::state::kTemporaryError, source_condition::kDefective);
  judge(ars408_layout::state::kTemperatureError, source_condition::kTemperature);
  judge(ars408_layout::state::kVoltageError, source_condition::kSupply);
  judge(ars408_layout::state::kMotion, source_condition::kWithoutEgoMotion);
  return conditions;
}

}  // namespace

Ars408::Ars408(unsigned sensor_id) : id_offset_((sensor_id & ars408_layout::kMaxSensorId) * ars408_layout::kIdStep) {}

void Ars408::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  if (frame.kind == recording::FrameKind::kUdp || frame.can_extended || frame.can_remote) return;
  tick(stamp.received_ns, output);
  for (const FrameKind* const kind : kFrames) {
    if (frame.can_id != kind->id + id_offset_) continue;
    if (frame.payload.size() != kind->bytes) {
      report(output, Fault::kWireLength, "ARS408 %s frame of %zu bytes, must be %zu", kind->name, frame.payload.size(),
             kind->bytes);
      return;
    }
    if (kind == &kState) return output.report_conditions(conditions_of(frame.payload));
    const List list = kind->id < ars408_layout::kObjectStatusId || kind->id >= ars408_layout::kClusterGeneralId
                          ? List::kClusters
                          : List::kObjects;
    if (kind == &kClusterStatus || kind == &kObjectStatus) return take_status(list, frame.payload, stamp, output);
    return take_entry(list, kind == &kClusterQuality || kind == &kObjectQuality, frame.payload, stamp, output);
  }
}

void Ars408::tick(std::int64_t now_ns, DecoderOutput& output) {
  if (open_ != List::kNone && now_ns - last_ns_ > kArs408Silence_ns) finish(output);
}

void Ars408::take_status(List list, Payload payload, const FrameStamp& stamp, DecoderOutput& output) {
  if (open_ != List::kNone) finish(output);
  std::size_t announced = 0;
  if (list == List::kClusters) {
    announced = raw(ars408_layout::cluster_status::kNear, payload) + raw(ars408_layout::cluster_status::kFar, payload);
    counter_ = static_cast<std::uint32_t>(raw(ars408_layout::cluster_status::kMeasurementCounter, payload));
  } else {
    announced = raw(ars408_layout::object_status::kCount, payload);
    counter_ = static_cast<std::uint32_t>(raw(ars408_layout::object_status::kMeasurementCounter, payload));
  }
  started_ = true;
  stray_reported_ = false;
  if (announced > entries_.size()) {
    report(output, Fault::kWireValue, "ARS408 cluster status: number of near and far clusters %zu, allowed 0 … %zu",
           announced, entries_.size());
    stray_reported_ = true;
    return;
  }
  open_ = list;
  announced_ = announced;
  with_general_ = with_quality_ = with_both_ = 0;
  for (Entry& entry : entries_) entry.has_general = entry.has_quality = false;
  first_ = stamp;
  last_ns_ = stamp.received_ns;
  if (is_complete()) finish(output);
}

void Ars408::take_entry(List list, bool is_quality, Payload payload, const FrameStamp& stamp, DecoderOutput& output) {
  const char* const what = list == List::kClusters ? "cluster" : "object";
  const unsigned id = payload[0];
  if (list != open_) {
    if (is_quality && quality_ == Quality::kAbsent && started_ && !stray_reported_) {
      // The sensor sends quality frames: from now on a cycle is complete only with them.
      quality_ = Quality::kUnknown;
      stray_reported_ = true;
    }
    if (started_ && !stray_reported_) {
      report(output, Fault::kWireValue,
             "ARS408 %s %u outside of a cycle: status frame %03x is missing or announced fewer", what, id,
             (list == List::kClusters ? ars408_layout::kClusterStatusId : ars408_layout::kObjectStatusId) + id_offset_);
      stray_reported_ = true;
    }
    return;
  }
  Entry& entry = entries_[id];
  bool& present = is_quality ? entry.has_quality : entry.has_general;
  std::size_t& count = is_quality ? with_quality_ : with_general_;
  if (present) {
    report(output, Fault::kWireValue, "ARS408 %s %u occurs twice in a cycle; the first one is used", what, id);
    return;
  }
  if (count == announced_) {
    report(output, Fault::kWireValue, "ARS408 %s %u exceeds the %zu that the status frame announced", what, id,
           announced_);
    return;
  }
  if (is_quality) {
    std::copy(payload.begin(), payload.end(), entry.quality.begin());
  } else {
    std::copy(payload.begin(), payload.end(), entry.general.begin());
    order_[with_general_] = static_cast<std::uint8_t>(id);
  }
  present = true;
  ++count;
  if (entry.has_general && entry.has_quality) ++with_both_;
  last_ns_ = stamp.received_ns;
  if (is_complete()) finish(output);
}

bool Ars408::is_complete() const {
  if (announced_ == 0) return true;
  return quality_ == Quality::kAbsent ? with_general_ == announced_ : with_both_ == announced_;
}

void Ars408::finish(DecoderOutput& output) {
  const bool all_general = with_general_ == announced_;
  const bool expects_quality = quality_ == Quality::kSent || with_quality_ > 0;
  const bool complete = all_general && (!expects_quality || with_both_ == announced_);
  if (!complete) {
    report(output, Fault::kWireLength,
           "ARS408 %s cycle %u is incomplete: %zu of %zu general and %zu of %zu quality frames are missing",
           open_ == List::kClusters ? "cluster" : "object", counter_, announced_ - with_general_, announced_,
           expects_quality ? announced_ - with_quality_ : std::size_t{0},
           expects_quality ? announced_ : std::size_t{0});
  }
  if (with_quality_ > 0) {
    quality_ = Quality::kSent;
  } else if (all_general && announced_ > 0) {
    // Missing for the first time: the next cycle shows if they were lost or are no longer sent.
    quality_ = quality_ == Quality::kSent ? Quality::kUnknown : Quality::kAbsent;
  }
  publish(complete, output);
  open_ = List::kNone;
}

void Ars408::publish(bool complete, DecoderOutput& output) const {
  RadarScan* const scan = output.begin_scan();
  if (scan == nullptr) return;
  scan->cycle_counter = counter_;
  scan->number_of_valid_detections = static_cast<std::uint32_t>(with_general_);
  scan->dropped_detections = 0;
  scan->integrity = complete ? 0 : scan_integrity::kIncomplete;
  scan->fields = scan_field::kRcs | (with_both_ > 0 ? scan_field::kStds | scan_field::kExistence : 0u);
  scan->range_rate_min_mps = scan->range_rate_max_mps = 0.0F;
  for (std::size_t i = 0; i < with_general_; ++i) write_entry(entries_[order_[i]], i, *scan);
  output.publish_scan(first_, std::nullopt, 16);
}

void Ars408::write_entry(const Entry& entry, std::size_t i, RadarScan& scan) const {
  const bool cluster = open_ == List::kClusters;
  const wire::CanSignal& lateral =
      cluster ? ars408_layout::general::kClusterLateral_m : ars408_layout::general::kObjectLateral_m;
  const double x = wire::extract(ars408_layout::general::kLongitudinal_m, entry.general);
  const double y = wire::extract(lateral, entry.general);
  const double vx = wire::extract(ars408_layout::general::kLongitudinalVelocity_mps, entry.general);
  const double vy = wire::extract(ars408_layout::general::kLateralVelocity_mps, entry.general);
  const double range = std::hypot(x, y);
  const double azimuth = std::atan2(y, x);
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  scan.range_m[i] = static_cast<float>(range);
  scan.azimuth_rad[i] = static_cast<float>(azimuth);
  scan.elevation_rad[i] = scan.elevation_std_rad[i] = 0.0F;
  scan.range_rate_mps[i] = static_cast<float>(c * vx + s * vy);
  scan.rcs_dbsm[i] = static_cast<float>(wire::extract(ars408_layout::general::kRcs_dbsm, entry.general));
  scan.snr_db[i] = 0.0F;
  scan.range_std_m[i] = scan.azimuth_std_rad[i] = scan.range_rate_std_mps[i] = 0.0F;
  scan.existence_probability[i] = 1.0F;
  scan.detection_flags[i] = 0;
  if (!entry.has_quality) return;

  const Payload quality = entry.quality;
  double var_x = 0.0, var_y = 0.0, var_vx = 0.0, var_vy = 0.0;
  // Errors along x and y are assumed independent. The azimuth's variance is at most that of a uniform distribution.
  if (variance_of(ars408_layout::quality::kLongitudinal, quality, ars408_layout::general::kLongitudinal_m, var_x) &&
      variance_of(ars408_layout::quality::kLateral, quality, lateral, var_y)) {
    constexpr double kUniform = std::numbers::pi * std::numbers::pi / 3.0;
    const double across = s * s * var_x + c * c * var_y;
    const double azimuth_variance = across < kUniform * range * range ? across / (range * range) : kUniform;
    scan.range_std_m[i] = static_cast<float>(std::sqrt(c * c * var_x + s * s * var_y));
    scan.azimuth_std_rad[i] = static_cast<float>(std::sqrt(azimuth_variance));
    if (variance_of(ars408_layout::quality::kLongitudinalVelocity, quality,
                    ars408_layout::general::kLongitudinalVelocity_mps, var_vx) &&
        variance_of(ars408_layout::quality::kLateralVelocity, quality, ars408_layout::general::kLateralVelocity_mps,
                    var_vy)) {
      // The line of sight of the projected velocity is as uncertain as the azimuth.
      const double turned = c * vy - s * vx;
      scan.range_rate_std_mps[i] =
          static_cast<float>(std::sqrt(c * c * var_vx + s * s * var_vy + turned * turned * azimuth_variance));
    }
  }
  bool valid = true;
  if (cluster) {
    const std::size_t false_alarm = raw(ars408_layout::cluster_quality::kFalseAlarm, quality);
    scan.existence_probability[i] = static_cast<float>(1.0 - probability_of(false_alarm, 0.0));
    valid = has_bit(ars408_layout::kValidStates, raw(ars408_layout::cluster_quality::kInvalidState, quality));
    const std::size_t ambiguity = raw(ars408_layout::cluster_quality::kAmbiguityState, quality);
    if (ambiguity < ars408_layout::kAmbiguityStaggeredRamp || ambiguity > ars408_layout::kAmbiguityStationary) {
      scan.detection_flags[i] |= detection_flag::kAmbiguous;
    }
  } else {
    const std::size_t existence = raw(ars408_layout::object_quality::kExistence, quality);
    scan.existence_probability[i] = static_cast<float>(probability_of(existence, 1.0));
    valid = has_bit(ars408_layout::kMeasuredStates, raw(ars408_layout::object_quality::kMeasurementState, quality));
  }
  if (!valid) scan.detection_flags[i] |= detection_flag::kInvalid;
}

}  // namespace boresight::ingest
