// A mapping file of a CAN radar or of the vehicle's signals with all names of the DBC file resolved: plain tables for
// the decoders codecs/table_radar and codecs/table_ego.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/wire/can_signal.hpp"
#include "services/common/e2e/profile.hpp"
#include "services/ingest_gateway/dbc/dbc.hpp"

namespace boresight::ingest::dbc {

/// A multiplexed signal is present only if its switch has one of these raw values.
struct SwitchCondition {
  wire::CanSignal signal;
  std::vector<ValueRange> values;

  [[nodiscard]] bool operator==(const SwitchCondition& other) const {
    return signal.start_bit == other.signal.start_bit && signal.length == other.signal.length &&
           signal.order == other.signal.order && values == other.values;
  }
};

[[nodiscard]] inline bool all_hold(const std::vector<SwitchCondition>& conditions,
                                   std::span<const std::uint8_t> payload) {
  return std::all_of(conditions.begin(), conditions.end(), [&](const SwitchCondition& condition) {
    const std::uint64_t value = wire::extract_bits(condition.signal, payload);
    return std::any_of(condition.values.begin(), condition.values.end(),
                       [value](const ValueRange& range) { return range.first <= value && value <= range.last; });
  });
}

/// value = physical · factor + offset, in the quantity's unit; all conditions must hold. The payloads below are at
/// least as long as the signal's message.
struct MappedSignal {
  wire::CanSignal signal{{}, 0, 1, wire::ByteOrder::kIntel, false, 1.0, 0.0};
  double factor = 1.0;
  double offset = 0.0;
  std::vector<SwitchCondition> conditions;

  [[nodiscard]] bool is_in(std::span<const std::uint8_t> payload) const { return all_hold(conditions, payload); }
  [[nodiscard]] double value(std::span<const std::uint8_t> payload) const {
    return wire::extract(signal, payload) * factor + offset;
  }
  [[nodiscard]] std::int64_t raw(std::span<const std::uint8_t> payload) const {
    return wire::extract_raw(signal, payload);
  }
};

/// Checksums of vehicle manufacturers instead of E2E protection.
enum class Checksum : std::uint8_t {
  kNone,
  kToyota,  ///< last byte: sum over id, length and the other bytes
};

/// A CAN message and the checks that it must pass.
struct MappedMessage {
  std::uint32_t id = 0;
  bool extended = false;
  std::string name;  ///< for fault texts
  std::uint16_t length_bytes = 0;
  Checksum checksum = Checksum::kNone;
  e2e::Config protection;  ///< Profile::kNone: unprotected; else over the message's length

  /// For sorting and searching.
  [[nodiscard]] std::uint64_t key() const { return key_of(id, extended); }
  [[nodiscard]] static std::uint64_t key_of(std::uint32_t id, bool extended) {
    return std::uint64_t{extended ? 1u : 0u} << 32 | id;
  }
};

/// A condition that holds for some raw values of a signal.
struct MappedState {
  MappedSignal signal;
  std::vector<std::int64_t> values;
  bool except = false;  ///< the condition holds for all other values

  [[nodiscard]] bool holds(std::span<const std::uint8_t> payload) const {
    return (std::find(values.begin(), values.end(), signal.raw(payload)) != values.end()) != except;
  }
};

/// Quantity of a detection's signal, in metres, radians, m/s, dB and dBsm; signs as in RadarScan.
enum class Quantity : std::uint8_t {
  kRange,
  kLongitudinal,
  kLateral,
  kAzimuth,
  kElevation,
  kRangeRate,
  kVelocityLongitudinal,
  kVelocityLateral,
  kRcs,
  kSnr,
  kExistence,
  kRangeStd,
  kAzimuthStd,
  kElevationStd,
  kRangeRateStd,
};
inline constexpr std::size_t kNumberOfQuantities = 15;

[[nodiscard]] constexpr std::uint32_t bit_of(Quantity quantity) {
  return 1u << static_cast<unsigned>(quantity);
}

/// Source of a detection's index within its cycle.
enum class SlotBy : std::uint8_t {
  kIndex,    ///< the message, or the signals' names within it
  kSignal,   ///< a signal of the message, which is sent once per detection
  kArrival,  ///< the order of arrival of the messages
};

/// One of the conditions for a valid detection.
struct Validity {
  MappedState state;
  std::uint8_t bit = 1;  ///< 1 << number of the condition
};

/// The signals of one message for one detection; other messages may hold further parts of the same detection.
struct DetectionPart {
  SlotBy slot_by = SlotBy::kIndex;
  std::uint16_t slot = 0;     ///< of the detection, or of the first one of its group
  std::uint16_t slots = 1;    ///< in the group
  std::uint8_t part_bit = 1;  ///< 1 << number of the part of the detection
  MappedSignal slot_signal;   ///< kSignal: raw value − slot_signal_first = place in the group
  std::int64_t slot_signal_first = 0;
  std::vector<std::pair<Quantity, MappedSignal>> quantities;
  std::vector<Validity> valid;  ///< a detection is valid if all were received and hold
  /// The part is in the frame if these hold: the conditions that all of its signals share.
  std::vector<SwitchCondition> conditions;
};

struct RadarMessage {
  MappedMessage frame;
  std::vector<DetectionPart> parts;
  bool is_header = false;
  bool is_last = false;
  std::vector<MappedSignal> counts;     ///< header: their sum is the number of detections of the cycle
  std::optional<MappedSignal> counter;  ///< cycle counter
};

enum class CycleEnd : std::uint8_t {
  kAllMessages,  ///< with the last part of the last detection
  kLastMessage,  ///< with the message that is_last
  kCount,        ///< with the number of detections in the header
  kTimeout,      ///< after a pause of the time-out
};

struct RadarMapping {
  std::vector<RadarMessage> messages;  ///< sorted by frame.key()
  CycleEnd cycle_end = CycleEnd::kAllMessages;
  std::int64_t timeout_ns = 20'000'000;  ///< an incomplete cycle ends after such a pause
  bool header_begins_cycle = false;
  std::vector<std::uint8_t> parts_of_slot;  ///< of each detection: the bits of all of its parts
  std::uint32_t quantities = 0;             ///< bits of those that are mapped
  unsigned counter_bits = 0;                ///< 0: no counter
  std::vector<std::string> warnings;        ///< lines of the DBC file that could not be used
};

/// A quantity made of the signals of one message.
struct EgoQuantity {
  std::vector<MappedSignal> signals;
  bool sum = false;  ///< sum of the signals; else their mean
  double plausible_min = 0.0;
  double plausible_max = 0.0;
};

/// Counters of wheel pulses: their mean step by the time between two frames is the speed.
struct EgoPulses {
  std::vector<MappedSignal> signals;
  std::vector<std::uint64_t> wraps;  ///< each counter goes from wrap − 1 to 0
  double metres_per_pulse = 0.0;
  std::int64_t window_ns = 0;  ///< the speed is the mean over this time
  double plausible_max_mps = 0.0;
};

/// The signals of one message for the vehicle's motion; units as in EgoMotion.
struct EgoMessage {
  MappedMessage frame;
  std::optional<EgoQuantity> speed_mps;
  bool speed_is_signed = false;
  std::optional<EgoPulses> pulses;
  std::optional<EgoQuantity> yaw_rate_radps;
  std::optional<EgoQuantity> steering_angle_rad;
  std::optional<MappedState> reverse;
};

struct EgoMapping {
  std::vector<EgoMessage> messages;   ///< sorted by frame.key()
  std::vector<std::string> warnings;  ///< lines of the DBC file that could not be used
};

inline constexpr std::size_t kMaxWheels = 8;

}  // namespace boresight::ingest::dbc
