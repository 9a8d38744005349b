// A DBC file: the messages of a CAN bus and the layout of their signals.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::ingest::dbc {

/// Role of a signal in multiplexing.
enum class MultiplexRole : std::uint8_t {
  kNone,            ///< always present
  kSwitch,          ///< "M": always present; its raw value selects others
  kValue,           ///< "m<N>": present if its switch has a value in its ranges
  kValueAndSwitch,  ///< "m<N>M": both
};

/// Closed interval of a switch's raw values.
struct ValueRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  [[nodiscard]] bool operator==(const ValueRange&) const = default;
};

inline constexpr std::size_t kNoSignal = static_cast<std::size_t>(-1);

struct Signal {
  std::string name;
  std::uint16_t start_bit = 0;
  std::uint8_t length = 0;  ///< 1 … 64 bits
  wire::ByteOrder order = wire::ByteOrder::kIntel;
  bool is_signed = false;
  double factor = 1.0;
  double offset = 0.0;
  double minimum = 0.0;  ///< as in the file; 0 and 0 often mean "not stated"
  double maximum = 0.0;
  wire::SignalKind kind = wire::SignalKind::kInteger;
  std::string unit;
  MultiplexRole role = MultiplexRole::kNone;
  std::size_t switch_index = kNoSignal;   ///< of a multiplexed signal: its switch, within the same message
  std::vector<ValueRange> switch_values;  ///< of a multiplexed signal: values for which it is present; never empty

  /// For extraction; without a name, so that it may outlive this signal.
  [[nodiscard]] wire::CanSignal can_signal() const {
    return {{}, start_bit, length, order, is_signed, factor, offset, kind};
  }
  [[nodiscard]] bool is_multiplexed() const {
    return role == MultiplexRole::kValue || role == MultiplexRole::kValueAndSwitch;
  }
  [[nodiscard]] bool is_switch() const {
    return role == MultiplexRole::kSwitch || role == MultiplexRole::kValueAndSwitch;
  }
};

struct Message {
  std::uint32_t id = 0;  ///< 11 bits, or 29 if extended
  bool extended = false;
  std::string name;
  std::uint16_t length_bytes = 0;  ///< 0 … 64
  std::vector<Signal> signals;     ///< each lies within length_bytes

  /// The signal of that name, or nullptr.
  [[nodiscard]] const Signal* find(std::string_view signal) const;
};

struct Database {
  std::vector<Message> messages;
  /// Lines that could not be used, "file:line: …"; the rest of the file is in `messages`. At most kMaxProblems, the
  /// last of which states that there are more.
  std::vector<std::string> problems;

  /// The message of that name, or nullptr.
  [[nodiscard]] const Message* find(std::string_view message) const;
};

inline constexpr std::size_t kMaxProblems = 200;
/// Largest depth of multiplexing: signals under switches that are themselves multiplexed.
inline constexpr std::size_t kMaxSwitches = 4;

/// Reads the text of a DBC file. Messages, signals, their float kinds (SIG_VALTYPE_) and extended multiplexing
/// (SG_MUL_VAL_) are read, all other statements are skipped. The text is not trusted: an invalid line is reported and
/// skipped. Time grows as n·log n with the text. Messages with bit 30 of their id set hold CANdb++'s signals that are
/// on no bus, and are skipped without a problem.
[[nodiscard]] Database parse_dbc(std::string_view text, std::string_view file_name);

}  // namespace boresight::ingest::dbc
