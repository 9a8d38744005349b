#include "services/ingest_gateway/mapping/detection_group.hpp"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
#include "services/ingest_gateway/dbc/names.hpp"

namespace boresight::ingest {

namespace {

using dbc::CycleEnd;
using dbc::Quantity;
using dbc::SlotBy;

struct QuantityKey {
  std::string_view key;
  Quantity quantity;
  Dimension dimension;
};
constexpr std::array kQuantityKeys = {
    QuantityKey{"range", Quantity::kRange, Dimension::kLength},
    QuantityKey{"longitudinal", Quantity::kLongitudinal, Dimension::kLength},
    QuantityKey{"lateral", Quantity::kLateral, Dimension::kLength},
    QuantityKey{"azimuth", Quantity::kAzimuth, Dimension::kAngle},
    QuantityKey{"elevation", Quantity::kElevation, Dimension::kAngle},
    QuantityKey{"range_rate", Quantity::kRangeRate, Dimension::kSpeed},
    QuantityKey{"velocity_longitudinal", Quantity::kVelocityLongitudinal, Dimension::kSpeed},
    QuantityKey{"velocity_lateral", Quantity::kVelocityLateral, Dimension::kSpeed},
    QuantityKey{"rcs", Quantity::kRcs, Dimension::kNone},
    QuantityKey{"snr", Quantity::kSnr, Dimension::kNone},
    QuantityKey{"existence", Quantity::kExistence, Dimension::kRatio},
    QuantityKey{"range_std", Quantity::kRangeStd, Dimension::kLength},
    QuantityKey{"azimuth_std", Quantity::kAzimuthStd, Dimension::kAngle},
    QuantityKey{"elevation_std", Quantity::kElevationStd, Dimension::kAngle},
    QuantityKey{"range_rate_std", Quantity::kRangeRateStd, Dimension::kSpeed},
};
static_assert(kQuantityKeys.size() == dbc::kNumberOfQuantities);
constexpr std::size_t kMaxParts = 8;

/// One table [[detections]]: its messages for each index, in the order of the file.
struct Group {
  SlotBy slot_by = SlotBy::kIndex;
  unsigned first_index = 0;
  std::size_t instances = 1;  // of messages or of signals in them; 1 unless the index gives the slot
  std::size_t first_slot = 0;
  std::size_t slots = 1;
  std::vector<std::vector<const dbc::Message*>> messages;  // [instance][number in the table]
};

class GroupReader {
 public:
  GroupReader(const Resolver& names, RadarParts& radar) : names_(names), radar_(radar) {}

  void read(config::Reader& table) {
    Group group;
    group.first_slot = radar_.mapping().parts_of_slot.size();
    group.slot_by = table.choice<SlotBy>(
        "slot_by", {{"index", SlotBy::kIndex}, {"signal", SlotBy::kSignal}, {"arrival", SlotBy::kArrival}},
        SlotBy::kIndex);
    constexpr config::Range kSlots{1, static_cast<double>(kMaxDetections)};
    const std::vector<std::int64_t> index = table.integers("index", {2, 2}, {0, 9999}, {0, 0});
    const auto slots = static_cast<std::size_t>(table.integer("slots", kSlots, 1));
    if (group.slot_by == SlotBy::kIndex) {
      if (table.has("slots")) table.reject("slots", "is allowed with slot_by = \"signal\" or \"arrival\" only");
      if (index[1] < index[0] || index[1] - index[0] >= static_cast<std::int64_t>(kMaxDetections)) {
        table.reject("index", fmt::format("must be [first, last] with at most {} numbers", kMaxDetections));
      } else {
        group.first_index = static_cast<unsigned>(index[0]);
        group.slots = group.instances = static_cast<std::size_t>(index[1] - index[0]) + 1;
      }
    } else {
      if (table.has("index")) table.reject("index", "is allowed with slot_by = \"index\" only");
      if (radar_.mapping().cycle_end == CycleEnd::kAllMessages) {
        table.reject("slot_by", "a cycle that ends with all_messages needs \"index\"");
      }
      table.require("slots");
      group.slots = slots;
    }
    if (group.first_slot + group.slots > kMaxDetections) {
      table.reject("", fmt::format("there are more than {} detections in all", kMaxDetections));
      return;
    }
    radar_.mapping().parts_of_slot.resize(group.first_slot + group.slots);
    group.messages.resize(group.instances);
    std::vector<config::Reader> message_tables = table.tables("message");
    table.require("message");
    if (message_tables.size() > kMaxParts || (group.slot_by == SlotBy::kArrival && message_tables.size() > 1)) {
      table.reject("message",
                   group.slot_by == SlotBy::kArrival ? "must be one with slot_by = \"arrival\"" : "must be at most 8");
      return;
    }
    bool is_complete = !message_tables.empty();
    for (config::Reader& message : message_tables) is_complete &= read_messages(message, group);
    read_signals(table, message_tables, group, is_complete);
  }

 private:
  /// One table [[detections.message]]: its message for each instance.
  bool read_messages(config::Reader& table, Group& group) {
    const std::vector<std::string> names = table.texts("names", {});
    const std::string pattern = table.text("name", "");
    Protection protection(table, group.instances);
    if (table.has("name") == table.has("names")) {
      table.reject("", "needs either name, which may have {} for the index, or names");
      return false;
    }
    if (table.has("names") && names.size() != group.instances) {
      table.reject("names", fmt::format("has {} names for {} indices", names.size(), group.instances));
      return false;
    }
    for (std::size_t i = 0; i < group.instances; ++i) {
      const std::string_view key = names.empty() ? "name" : "names";
      const std::optional<std::string> name = expand(table, key, names.empty() ? pattern : names[i], group, i);
      const dbc::Message* const message = name ? names_.message(table, key, *name) : nullptr;
      if (message == nullptr) return false;
      dbc::RadarMessage& mapped = radar_.entry(table, key, *message);
      if (protection.is_stated()) protection.apply(mapped.frame, i);
      group.messages[i].push_back(message);
    }
    return true;
  }

  static std::optional<std::string> expand(config::Reader& table, std::string_view key, const std::string& pattern,
                                           const Group& group, std::size_t instance) {
    auto name = dbc::expand(pattern, group.first_index + static_cast<unsigned>(instance));
    if (!name) table.reject(key, "braces must be {} or, padded with zeros to 1 … 9 digits, {:02}");
    return name;
  }

  /// The signal of a table `{ signal = "…", message = 1 }` in one instance of the group; nullptr with the error noted.
  const dbc::Signal* find_signal(config::Reader& table, const Group& group, std::size_t instance,
                                 const std::string& pattern, std::size_t only_in, std::size_t& found_in) {
    const auto name = expand(table, "signal", pattern, group, instance);
    if (!name) return nullptr;
    const auto& messages = group.messages[instance];
    if (only_in == 0) return names_.signal(table, "signal", messages, *name, found_in);
    if (only_in > messages.size()) {
      table.reject("message", fmt::format("must be 1 … {}", messages.size()));
      return nullptr;
    }
    found_in = only_in - 1;
    return names_.signal(table, "signal", *messages[found_in], *name);
  }

  void read_signals(config::Reader& table, std::vector<config::Reader>& message_tables, const Group& group,
                    bool has_messages) {
    table.require("signals");
    config::Reader signals = table.table("signals");
    std::uint32_t mapped = 0;
    for (const QuantityKey& key : kQuantityKeys) {
      if (!signals.has(key.key)) {
        static_cast<void>(signals.table(key.key));  // a known key, but absent
        continue;
      }
      mapped |= dbc::bit_of(key.quantity);
      config::Reader quantity = signals.table(key.key);
      const Conversion conversion = read_conversion(quantity, key.dimension);
      for_each_instance(quantity, group, has_messages,
                        [&](dbc::DetectionPart& part, const dbc::Message& message, const dbc::Signal& signal) {
                          part.quantities.emplace_back(key.quantity, map_signal(message, signal, conversion, quantity));
                        });
    }
    if (radar_.mapping().quantities != 0 && radar_.mapping().quantities != mapped) {
      signals.reject("", "all tables [[detections]] must map the same quantities");
    }
    radar_.mapping().quantities = mapped;
    check_quantities(signals, mapped);
    std::vector<config::Reader> conditions = table.tables("valid");
    if (conditions.size() > kMaxParts) {
      table.reject("valid", "must be at most 8");
      conditions.clear();
    }
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      config::Reader& valid = conditions[i];
      const auto bit = static_cast<std::uint8_t>(1u << i);
      const dbc::MappedState state = read_state(valid);
      for_each_instance(valid, group, has_messages,
                        [&](dbc::DetectionPart& part, const dbc::Message& message, const dbc::Signal& signal) {
                          part.valid.push_back({state, bit});
                          part.valid.back().state.signal = map_signal(message, signal);
                        });
    }
    const std::string counter = table.text("counter", "");
    if (!counter.empty() && has_messages) read_counter(table, group, counter);
    for (std::size_t i = 0; i < message_tables.size(); ++i) {
      finish_message(message_tables[i], group, i, has_messages);
    }
    if (!has_messages) return;
    for (const dbc::Message* message : messages_of(group)) {
      radar_.merge_parts(*message, group.first_slot, group.slots);
    }
    const std::uint8_t bits = radar_.mapping().parts_of_slot[group.first_slot];
    if (group.slot_by == SlotBy::kArrival && (bits & (bits - 1)) != 0) {
      table.reject("signals", "with slot_by = \"arrival\" all signals must be in the same frames");
    }
    for (std::size_t slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
      radar_.mapping().parts_of_slot[slot] =
          radar_.mapping().parts_of_slot[group.slot_by == SlotBy::kIndex ? slot : group.first_slot];
    }
  }

  static std::set<const dbc::Message*> messages_of(const Group& group) {
    std::set<const dbc::Message*> messages;
    for (const auto& instance : group.messages) messages.insert(instance.begin(), instance.end());
    return messages;
  }

  template <typename Add>
  void for_each_instance(config::Reader& table, const Group& group, bool has_messages, Add add) {
    table.require("signal");
    const std::string pattern = table.text("signal", "");
    const auto only_in = static_cast<std::size_t>(table.integer("message", {1, static_cast<double>(kMaxParts)}, 0));
    for (std::size_t i = 0; has_messages && i < group.instances; ++i) {
      std::size_t in = 0;
      const dbc::Signal* const signal = find_signal(table, group, i, pattern, only_in, in);
      if (signal == nullptr) return;  // one error for all instances
      const RadarParts::Place place{.message = group.messages[i][in],
                                    .slot_by = group.slot_by,
                                    .slot = group.first_slot + i,
                                    .slots = group.slot_by == SlotBy::kIndex ? 1 : group.slots};
      dbc::DetectionPart* const part = radar_.part_for(table, place, *signal);
      if (part == nullptr) return;
      add(*part, *group.messages[i][in], *signal);
    }
  }

  static void check_quantities(config::Reader& signals, std::uint32_t mapped) {
    const auto has = [mapped](Quantity quantity) { return (mapped & dbc::bit_of(quantity)) != 0; };
    const bool polar = has(Quantity::kRange) && has(Quantity::kAzimuth);
    const bool cartesian = has(Quantity::kLongitudinal) && has(Quantity::kLateral);
    const bool any_polar = has(Quantity::kRange) || has(Quantity::kAzimuth) || has(Quantity::kElevation);
    const bool any_cartesian = has(Quantity::kLongitudinal) || has(Quantity::kLateral);
    if (polar == cartesian || (any_polar && any_cartesian)) {
      signals.reject("", "needs either range and azimuth (and elevation), or longitudinal and lateral");
    }
    if (has(Quantity::kRangeRate) == has(Quantity::kVelocityLongitudinal)) {
      signals.reject("", "needs either range_rate or velocity_longitudinal");
    }
    if (has(Quantity::kVelocityLateral) && !has(Quantity::kVelocityLongitudinal)) {
      signals.reject("", "velocity_lateral needs velocity_longitudinal");
    }
  }

  /// Several messages of a detection may have a counter; the first frame of a cycle gives the value.
  void read_counter(config::Reader& table, const Group& group, const std::string& pattern) {
    for (std::size_t i = 0; i < group.instances; ++i) {
      const auto name = expand(table, "counter", pattern, group, i);
      if (!name) return;
      bool found = false;
      for (const dbc::Message* message : group.messages[i]) {
        const dbc::Signal* const signal = message->find(*name);
        if (signal == nullptr) continue;
        found = true;
        radar_.add_counter(table, radar_.entry(table, "message", *message), *message, *signal);
      }
      if (!found) {
        table.reject("counter", fmt::format("there is no signal \"{}\" in \"{}\"", *name, group.messages[i][0]->name));
        return;
      }
    }
  }

  /// Checks and values that need all signals.
  void finish_message(config::Reader& table, const Group& group, std::size_t number, bool has_messages) {
    const bool by_signal = group.slot_by == SlotBy::kSignal;
    if (by_signal) table.require("slot_signal");
    const std::string slot_signal = table.text("slot_signal", "");
    const std::int64_t first = table.integer("slot_first", {-1e6, 1e6}, 0);
    if (!by_signal && table.has("slot_signal"))
      table.reject("slot_signal", "is allowed with slot_by = \"signal\" only");
    for (std::size_t i = 0; has_messages && i < group.instances; ++i) {
      const dbc::Message& message = *group.messages[i][number];
      dbc::RadarMessage& mapped = radar_.known(message);
      if (mapped.parts.empty()) {
        table.reject("", fmt::format("no signal is taken from \"{}\"", message.name));
        return;
      }
      if (!by_signal) continue;
      const dbc::Signal* const signal = names_.signal(table, "slot_signal", message, slot_signal);
      if (signal == nullptr) return;
      if (signal->is_multiplexed() || signal->kind != wire::SignalKind::kInteger) {
        table.reject("slot_signal", "must be an integer that is not multiplexed");
      }
      for (dbc::DetectionPart& part : mapped.parts) {
        if (part.slot != group.first_slot) continue;
        part.slot_signal = map_signal(message, *signal);
        part.slot_signal_first = first;
      }
    }
  }

  const Resolver& names_;
  RadarParts& radar_;
};

}  // namespace

void read_detection_group(config::Reader table, const Resolver& names, RadarParts& radar) {
  GroupReader(names, radar).read(table);
}

}  // namespace boresight::ingest
