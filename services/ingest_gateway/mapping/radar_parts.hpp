// The mapping of a radar while its file is read: its messages, and the signals of each detection.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"
#include "services/ingest_gateway/mapping/resolver.hpp"

namespace boresight::ingest {

class RadarParts {
 public:
  explicit RadarParts(const Resolver& names) : names_(names) {}

  /// The message's entry, created at its first use.
  dbc::RadarMessage& entry(config::Reader& at, std::string_view key, const dbc::Message& message);
  /// The same for a message that already has an entry.
  [[nodiscard]] dbc::RadarMessage& known(const dbc::Message& message) {
    return messages_.at(dbc::MappedMessage::key_of(message.id, message.extended));
  }
  void add_counter(config::Reader& table, dbc::RadarMessage& entry, const dbc::Message& message,
                   const dbc::Signal& signal);

  /// Message, condition and detection of a part.
  struct Place {
    const dbc::Message* message = nullptr;
    dbc::SlotBy slot_by = dbc::SlotBy::kIndex;
    std::size_t slot = 0;   ///< of the detection, or of the first one of its group
    std::size_t slots = 1;  ///< number of detections that the part may belong to
  };
  /// The part of a detection that a signal belongs to. Each message, and each condition of multiplexing in it, has a
  /// part of its own, since these arrive in different frames. nullptr with the error noted if there are too many parts.
  dbc::DetectionPart* part_for(config::Reader& table, const Place& place, const dbc::Signal& signal);
  /// Signals in every frame of a message have no part of their own if the detection's other signals in it are
  /// multiplexed: each of those parts includes them. The same holds below a switch that is multiplexed itself.
  void merge_parts(const dbc::Message& message, std::size_t first_slot, std::size_t slots);

  [[nodiscard]] bool has_counts() const;
  /// The readers fill in the fields that do not depend on messages and parts.
  [[nodiscard]] dbc::RadarMapping& mapping() { return mapping_; }
  /// The complete mapping; nothing can be added afterwards.
  [[nodiscard]] dbc::RadarMapping finish();

 private:
  struct PartKey {
    std::size_t slot;
    const dbc::Message* message;
    std::size_t switch_index;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> switch_values;
    auto operator<=>(const PartKey&) const = default;
  };

  const Resolver& names_;
  dbc::RadarMapping mapping_;
  std::map<std::uint64_t, dbc::RadarMessage> messages_;  // by the key before the offset of ids
  std::map<PartKey, std::size_t> part_index_;            // place among the parts of its message
};

}  // namespace boresight::ingest
