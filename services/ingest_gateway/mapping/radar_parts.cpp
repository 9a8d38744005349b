#include "services/ingest_gateway/mapping/radar_parts.hpp"

#include <algorithm>

namespace boresight::ingest {

namespace {

/// Conditions are ordered from the signal's own switch to the outermost one; outer switches have the last ones.
bool is_below(const std::vector<dbc::SwitchCondition>& inner, const std::vector<dbc::SwitchCondition>& outer) {
  return inner.size() > outer.size() && std::equal(outer.rbegin(), outer.rend(), inner.rbegin());
}

}  // namespace

dbc::RadarMessage& RadarParts::entry(config::Reader& at, std::string_view key, const dbc::Message& message) {
  const auto [found, is_new] =
      messages_.try_emplace(dbc::MappedMessage::key_of(message.id, message.extended), dbc::RadarMessage{});
  if (is_new) found->second.frame = names_.frame(at, key, message);
  return found->second;
}

void RadarParts::add_counter(config::Reader& table, dbc::RadarMessage& entry, const dbc::Message& message,
                             const dbc::Signal& signal) {
  const bool is_plain = signal.kind == wire::SignalKind::kInteger && !signal.is_signed && signal.length <= 32;
  if (!is_plain) table.reject("counter", "must be an unsigned integer of at most 32 bits");
  if (mapping_.counter_bits != 0 && mapping_.counter_bits != signal.length) {
    table.reject("counter", "must have the same number of bits everywhere");
  }
  mapping_.counter_bits = signal.length;
  entry.counter = map_signal(message, signal);
}

dbc::DetectionPart* RadarParts::part_for(config::Reader& table, const Place& place, const dbc::Signal& signal) {
  const dbc::Message& message = *place.message;
  dbc::RadarMessage& entry = known(message);
  const std::size_t slot = place.slot;
  PartKey key{slot, &message, signal.switch_index, {}};
  for (const dbc::ValueRange& range : signal.switch_values) key.switch_values.emplace_back(range.first, range.last);
  const auto found = part_index_.find(key);
  if (found != part_index_.end()) return &entry.parts[found->second];
  std::uint8_t& bits = mapping_.parts_of_slot[slot];
  if (bits == 0xFF) {
    table.reject("signal", "a detection comes in more than 8 parts");
    return nullptr;
  }
  dbc::DetectionPart part;
  part.slot_by = place.slot_by;
  part.slot = static_cast<std::uint16_t>(slot);
  part.slots = static_cast<std::uint16_t>(place.slots);
  part.part_bit = static_cast<std::uint8_t>(bits + 1);  // bits are 2^n − 1
  part.conditions = map_conditions(message, signal);
  bits = static_cast<std::uint8_t>(bits | part.part_bit);
  part_index_.emplace(std::move(key), entry.parts.size());
  entry.parts.push_back(std::move(part));
  return &entry.parts.back();
}

void RadarParts::merge_parts(const dbc::Message& of, std::size_t first_slot, std::size_t slots) {
  dbc::RadarMessage& message = known(of);
  std::map<std::size_t, std::vector<std::size_t>> parts_by_slot;
  for (std::size_t i = 0; i < message.parts.size(); ++i) {
    const std::size_t slot = message.parts[i].slot;
    if (slot >= first_slot && slot < first_slot + slots) parts_by_slot[slot].push_back(i);
  }
  std::vector<bool> is_merged(message.parts.size());
  for (const auto& [slot, indices] : parts_by_slot) {
    for (const std::size_t outer : indices) {
      for (const std::size_t inner : indices) {
        if (!is_below(message.parts[inner].conditions, message.parts[outer].conditions)) continue;
        dbc::DetectionPart& into = message.parts[inner];
        const dbc::DetectionPart& from = message.parts[outer];
        into.quantities.insert(into.quantities.end(), from.quantities.begin(), from.quantities.end());
        into.valid.insert(into.valid.end(), from.valid.begin(), from.valid.end());
        is_merged[outer] = true;
      }
      if (!is_merged[outer]) continue;
      mapping_.parts_of_slot[slot] =
          static_cast<std::uint8_t>(mapping_.parts_of_slot[slot] & ~message.parts[outer].part_bit);
    }
  }
  std::vector<dbc::DetectionPart> kept;
  for (std::size_t i = 0; i < message.parts.size(); ++i) {
    if (!is_merged[i]) kept.push_back(std::move(message.parts[i]));
  }
  message.parts = std::move(kept);
}

bool RadarParts::has_counts() const {
  return std::any_of(messages_.begin(), messages_.end(),
                     [](const auto& entry) { return !entry.second.counts.empty(); });
}

dbc::RadarMapping RadarParts::finish() {
  for (auto& [key, message] : messages_) mapping_.messages.push_back(std::move(message));
  mapping_.warnings = names_.warnings();
  return std::move(mapping_);
}

}  // namespace boresight::ingest
