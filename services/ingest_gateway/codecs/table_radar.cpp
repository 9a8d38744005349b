#include "services/ingest_gateway/codecs/table_radar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace boresight::ingest {

using dbc::CycleEnd;
using dbc::Quantity;
using dbc::SlotBy;

namespace {

constexpr double kPi = 3.14159265358979323846;

bool is_plausible(double range_m, double azimuth_rad, double elevation_rad, double range_rate_mps) {
  return range_m >= 0.0 && range_m <= 1500.0 && std::abs(azimuth_rad) <= kPi && std::abs(elevation_rad) <= kPi / 2.0 &&
         std::abs(range_rate_mps) <= 150.0;
}

/// Limits a value to the range of float, for an extreme factor of a mapping; such a detection is flagged.
float narrow(double value) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLimit, kLimit));
}

/// 0 means "not stated".
float std_of(double value) {
  return value > 0.0 ? narrow(value) : 0.0F;
}

}  // namespace

TableRadar::TableRadar(dbc::RadarMapping mapping) : mapping_(std::move(mapping)) {
  for (const dbc::RadarMessage& message : mapping_.messages) {
    keys_.push_back(message.frame.key());
    guards_.emplace_back(message.frame);
  }
  slots_.resize(mapping_.parts_of_slot.size());
  arrived_.resize(slots_.size());
  conditions_.resize(slots_.size());
  for (const dbc::RadarMessage& message : mapping_.messages) {
    for (const dbc::DetectionPart& part : message.parts) {
      for (const dbc::Validity& validity : part.valid) {
        for (std::size_t i = 0; i < part.slots; ++i) conditions_[part.slot + i] |= validity.bit;
      }
    }
  }
  clear();
}

void TableRadar::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  if (frame.can_remote) return;
  const std::uint64_t key = dbc::MappedMessage::key_of(frame.can_id, frame.can_extended);
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
  if (found == keys_.end() || *found != key) return;
  const auto index = static_cast<std::size_t>(found - keys_.begin());
  const dbc::RadarMessage& message = mapping_.messages[index];
  const Payload payload = guards_[index].usable(frame, output);
  if (payload.empty()) return;
  tick(stamp.received_ns, output);
  const bool begins = message.is_header && mapping_.header_begins_cycle;
  // A repeated part belongs to the next cycle; the current one remains incomplete.
  if (frames_ > 0 && (begins || began_before(message, payload))) finish(false, output);
  if (mapping_.header_begins_cycle && !begins && !has_header_) {
    if (!std::exchange(reported_orphan_, true)) output.fault(Fault::kWireLength, "detections without their header");
    return;
  }
  if (frames_++ == 0) first_ = stamp;
  last_ns_ = stamp.received_ns;
  if (message.counter && !has_counter_ && message.counter->is_in(payload)) {
    has_counter_ = true;
    counter_ = static_cast<std::uint32_t>(wire::extract_bits(message.counter->signal, payload));
  }
  if (message.is_header && !take_header(message, payload, output)) {
    clear();
    return;
  }
  for (const dbc::DetectionPart& part : message.parts) take_part(part, payload, output);
  if (is_complete(message)) finish(true, output);
}

void TableRadar::tick(std::int64_t now_ns, DecoderOutput& output) {
  if (frames_ == 0 || now_ns - last_ns_ <= mapping_.timeout_ns) return;
  finish(mapping_.cycle_end == CycleEnd::kTimeout, output);
}

bool TableRadar::take_header(const dbc::RadarMessage& message, Payload payload, DecoderOutput& output) {
  double count = 0.0;
  for (const dbc::MappedSignal& signal : message.counts) count += signal.value(payload);
  if (!(count >= 0.0 && count <= static_cast<double>(slots_.size()))) {
    output.fault(Fault::kWireValue, "number of detections in the header exceeds the mapped ones");
    return false;
  }
  has_header_ = true;
  reported_orphan_ = false;
  expected_ = static_cast<std::uint32_t>(count);
  return true;
}

bool TableRadar::began_before(const dbc::RadarMessage& message, Payload payload) const {
  return std::any_of(message.parts.begin(), message.parts.end(), [&](const dbc::DetectionPart& part) {
    if (part.slot_by == SlotBy::kArrival || !dbc::all_hold(part.conditions, payload)) return false;
    const std::size_t slot = slot_of(part, payload);
    return slot != kNoSlot && (slots_[slot].parts & part.part_bit) != 0;
  });
}

std::size_t TableRadar::slot_of(const dbc::DetectionPart& part, Payload payload) const {
  if (part.slot_by == SlotBy::kIndex) return part.slot;
  if (part.slot_by == SlotBy::kArrival) {
    return arrived_[part.slot] < part.slots ? std::size_t{part.slot} + arrived_[part.slot] : kNoSlot;
  }
  const std::int64_t number = part.slot_signal.raw(payload);
  if (number < part.slot_signal_first || number - part.slot_signal_first >= part.slots) return kNoSlot;
  return part.slot + static_cast<std::size_t>(number - part.slot_signal_first);
}

void TableRadar::take_part(const dbc::DetectionPart& part, Payload payload, DecoderOutput& output) {
  if (!dbc::all_hold(part.conditions, payload)) return;
  const std::size_t index = slot_of(part, payload);
  if (index == kNoSlot) {
    const bool is_full = part.slot_by == SlotBy::kArrival;
    if (is_full && dropped_ < std::numeric_limits<std::uint16_t>::max()) ++dropped_;
    output.fault(is_full ? Fault::kCapacity : Fault::kWireValue,
                 is_full ? "more detections in a cycle than mapped" : "number of a detection exceeds the mapped ones");
    return;
  }
  if (part.slot_by == SlotBy::kArrival) ++arrived_[part.slot];
  Slot& slot = slots_[index];
  if (slot.parts == 0) ++begun_slots_;
  slot.parts |= part.part_bit;
  if (slot.parts == mapping_.parts_of_slot[index]) ++complete_slots_;
  for (const auto& [quantity, signal] : part.quantities) {
    const double value = signal.value(payload);
    const bool is_number = std::isfinite(value);
    slot.not_a_number |= !is_number;
    slot.values[static_cast<std::size_t>(quantity)] = is_number ? value : 0.0;
    slot.present |= dbc::bit_of(quantity);
  }
  for (const dbc::Validity& validity : part.valid) {
    slot.judged |= validity.bit;
    slot.valid &= validity.state.holds(payload);
  }
}

bool TableRadar::is_complete(const dbc::RadarMessage& message) const {
  switch (mapping_.cycle_end) {
    case CycleEnd::kAllMessages:
      return complete_slots_ == slots_.size();
    case CycleEnd::kLastMessage:
      return message.is_last;
    case CycleEnd::kCount:
      return has_header_ && complete_slots_ >= expected_;
    case CycleEnd::kTimeout:
      break;
  }
  return false;
}

void TableRadar::finish(bool regularly, DecoderOutput& output) {
  const bool incomplete = !regularly || complete_slots_ != begun_slots_ || complete_slots_ < expected_;
  if (incomplete) output.fault(Fault::kWireLength, "frames of a cycle are missing");
  if (RadarScan* const scan = output.begin_scan()) {
    write_scan(*scan);
    scan->integrity = incomplete ? scan_integrity::kIncomplete : std::uint16_t{0};
    output.publish_scan(first_, std::nullopt, has_counter_ ? mapping_.counter_bits : 0);
  }
  clear();
}

void TableRadar::write_scan(RadarScan& scan) const {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    if (slot.valid && slot.judged == conditions_[i] && write_detection(slot, count, scan)) ++count;
  }
  const auto has = [this](Quantity quantity) { return (mapping_.quantities & dbc::bit_of(quantity)) != 0; };
  const bool has_stds = has(Quantity::kRangeStd) || has(Quantity::kAzimuthStd) || has(Quantity::kElevationStd) ||
                        has(Quantity::kRangeRateStd);
  scan.cycle_counter = counter_;
  scan.number_of_valid_detections = count;
  scan.dropped_detections = dropped_;
  scan.fields = (has(Quantity::kElevation) ? scan_field::kElevation : 0u) |
                (has(Quantity::kRcs) ? scan_field::kRcs : 0u) | (has(Quantity::kSnr) ? scan_field::kSnr : 0u) |
                (has(Quantity::kExistence) ? scan_field::kExistence : 0u) | (has_stds ? scan_field::kStds : 0u);
  scan.range_rate_min_mps = scan.range_rate_max_mps = 0.0F;
}

bool TableRadar::write_detection(const Slot& slot, std::size_t i, RadarScan& scan) const {
  constexpr std::uint32_t kPolar = dbc::bit_of(Quantity::kRange) | dbc::bit_of(Quantity::kAzimuth);
  constexpr std::uint32_t kCartesian = dbc::bit_of(Quantity::kLongitudinal) | dbc::bit_of(Quantity::kLateral);
  constexpr std::uint32_t kVelocity = dbc::bit_of(Quantity::kVelocityLongitudinal);
  const bool is_polar = (slot.present & kPolar) == kPolar;
  const bool has_range_rate = (slot.present & dbc::bit_of(Quantity::kRangeRate)) != 0;
  if (!is_polar && (slot.present & kCartesian) != kCartesian) return false;
  if (!has_range_rate && (slot.present & kVelocity) == 0) return false;
  const double x = slot.value(Quantity::kLongitudinal), y = slot.value(Quantity::kLateral);
  const double range = is_polar ? slot.value(Quantity::kRange) : std::hypot(x, y);
  const double azimuth = is_polar ? slot.value(Quantity::kAzimuth) : std::atan2(y, x);
  const double elevation = slot.value(Quantity::kElevation);
  // Component of the relative velocity along the line of sight, in the radar's plane.
  const double range_rate = has_range_rate ? slot.value(Quantity::kRangeRate)
                                           : slot.value(Quantity::kVelocityLongitudinal) * std::cos(azimuth) +
                                                 slot.value(Quantity::kVelocityLateral) * std::sin(azimuth);
  const bool is_sound = !slot.not_a_number && is_plausible(range, azimuth, elevation, range_rate);
  scan.range_m[i] = narrow(range);
  scan.azimuth_rad[i] = narrow(azimuth);
  scan.elevation_rad[i] = narrow(elevation);
  scan.range_rate_mps[i] = narrow(range_rate);
  scan.rcs_dbsm[i] = narrow(slot.value(Quantity::kRcs));
  scan.snr_db[i] = narrow(slot.value(Quantity::kSnr));
  scan.range_std_m[i] = std_of(slot.value(Quantity::kRangeStd));
  scan.azimuth_std_rad[i] = std_of(slot.value(Quantity::kAzimuthStd));
  scan.elevation_std_rad[i] = std_of(slot.value(Quantity::kElevationStd));
  scan.range_rate_std_mps[i] = std_of(slot.value(Quantity::kRangeRateStd));
  const bool has_existence = (mapping_.quantities & dbc::bit_of(Quantity::kExistence)) != 0;
  scan.existence_probability[i] =
      has_existence ? static_cast<float>(std::clamp(slot.value(Quantity::kExistence), 0.0, 1.0)) : 1.0F;
  scan.detection_flags[i] = is_sound ? std::uint16_t{0} : detection_flag::kUnusable;
  return true;
}

void TableRadar::clear() {
  for (Slot& slot : slots_) {
    slot.present = 0;
    slot.parts = slot.judged = 0;
    slot.valid = true;
    slot.not_a_number = false;
  }
  std::fill(arrived_.begin(), arrived_.end(), std::uint16_t{0});
  begun_slots_ = complete_slots_ = 0;
  frames_ = expected_ = counter_ = 0;
  dropped_ = 0;
  has_header_ = has_counter_ = false;
}

}  // namespace boresight::ingest
