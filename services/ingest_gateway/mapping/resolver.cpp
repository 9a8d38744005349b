#include "services/ingest_gateway/mapping/resolver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/text/near_names.hpp"

namespace boresight::ingest {

namespace {

struct Unit {
  std::string_view word;
  Dimension dimension;
  double factor;
};
/// Mapping files use the first word of each unit; DBC files also use the others.
constexpr std::array kUnits = {
    Unit{"m", Dimension::kLength, 1.0},          Unit{"cm", Dimension::kLength, 0.01},
    Unit{"mm", Dimension::kLength, 0.001},       Unit{"km", Dimension::kLength, 1000.0},
    Unit{"ft", Dimension::kLength, 0.3048},      Unit{"m/s", Dimension::kSpeed, 1.0},
    Unit{"km/h", Dimension::kSpeed, 1.0 / 3.6},  Unit{"mph", Dimension::kSpeed, 0.44704},
    Unit{"rad", Dimension::kAngle, 1.0},         Unit{"deg", Dimension::kAngle, kRadiansPerDegree},
    Unit{"rad/s", Dimension::kAngularRate, 1.0}, Unit{"deg/s", Dimension::kAngularRate, kRadiansPerDegree},
    Unit{"1", Dimension::kRatio, 1.0},           Unit{"%", Dimension::kRatio, 0.01},
};
struct Alias {
  std::string_view in_dbc, word;
};
constexpr std::array kAliases = {
    Alias{"meter", "m"},          Alias{"meters", "m"},     Alias{"metre", "m"},       Alias{"mps", "m/s"},
    Alias{"m/sec", "m/s"},        Alias{"kph", "km/h"},     Alias{"kmh", "km/h"},      Alias{"km/hr", "km/h"},
    Alias{"kmph", "km/h"},        Alias{"degree", "deg"},   Alias{"degrees", "deg"},   Alias{"\xC2\xB0", "deg"},
    Alias{"\xB0", "deg"},         Alias{"radians", "rad"},  Alias{"deg/sec", "deg/s"}, Alias{"degree/s", "deg/s"},
    Alias{"\xC2\xB0/s", "deg/s"}, Alias{"\xB0/s", "deg/s"}, Alias{"rad/sec", "rad/s"}, Alias{"percent", "%"},
};

std::optional<double> find_unit(std::string_view word, Dimension dimension) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Alias& alias : kAliases) {
    if (alias.in_dbc == lower) lower = alias.word;
  }
  for (const Unit& unit : kUnits) {
    if (unit.word == lower && unit.dimension == dimension) return unit.factor;
  }
  return std::nullopt;
}

std::vector<std::pair<std::string_view, double>> units_of(Dimension dimension) {
  std::vector<std::pair<std::string_view, double>> units;
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension) units.emplace_back(unit.word, unit.factor);
  }
  return units;
}

template <typename Items>
std::string near_text(const std::string& name, const Items& items) {
  std::vector<std::string> candidates;
  for (const auto& item : items) candidates.push_back(item.name);
  const std::vector<std::string> near = near_names(name, candidates);
  return near.empty() ? "" : fmt::format("; similar: {}", quoted(near));
}

}  // namespace

std::string quoted(const std::vector<std::string>& names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

Resolver::Resolver(config::Reader& root, std::string_view kind, const LoadDatabase& load) {
  root.require("kind");
  const std::string stated = root.text("kind", kind);
  if (stated != kind)
    root.reject("kind", fmt::format("is \"{}\", but a mapping of kind \"{}\" is needed", stated, kind));
  root.require("dbc");
  const std::string file = root.text("dbc", "");
  id_offset_ = static_cast<std::uint32_t>(root.integer("id_offset", {0, 0x1FFFFFFF}, 0));
  if (file.empty()) {
    if (root.has("dbc")) root.reject("dbc", "is empty");
    return;
  }
  try {
    database_ = load(file);
    is_loaded_ = true;
  } catch (const std::exception& error) {
    root.reject("dbc", error.what());
  }
}

const dbc::Message* Resolver::message(config::Reader& at, std::string_view key, const std::string& name) const {
  if (!is_loaded_) return nullptr;
  if (name.empty()) {
    if (at.has(key)) at.reject(key, "is empty");
    return nullptr;
  }
  const dbc::Message* const found = database_.find(name);
  if (found == nullptr) {
    at.reject(key,
              fmt::format("there is no message \"{}\" in the DBC file{}", name, near_text(name, database_.messages)));
  }
  return found;
}

const dbc::Signal* Resolver::signal(config::Reader& at, std::string_view key,
                                    const std::vector<const dbc::Message*>& messages, const std::string& name,
                                    std::size_t& found_in) const {
  const dbc::Signal* found = nullptr;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const dbc::Signal* const here = messages[i]->find(name);
    if (here == nullptr) continue;
    if (found != nullptr) {
      at.reject(key, fmt::format("signal \"{}\" is in the messages \"{}\" and \"{}\"; choose one: message = {} or {}",
                                 name, messages[found_in]->name, messages[i]->name, found_in + 1, i + 1));
      return nullptr;
    }
    found = here;
    found_in = i;
  }
  if (found != nullptr || messages.empty()) return found;
  std::vector<std::string> searched;
  std::vector<dbc::Signal> signals;
  for (const dbc::Message* message : messages) {
    searched.push_back(message->name);
    signals.insert(signals.end(), message->signals.begin(), message->signals.end());
  }
  at.reject(key, fmt::format("there is no signal \"{}\" in {}{}", name, quoted(searched), near_text(name, signals)));
  return nullptr;
}

const dbc::Signal* Resolver::signal(config::Reader& at, std::string_view key, const dbc::Message& message,
                                    const std::string& name) const {
  std::size_t ignored = 0;
  return signal(at, key, {&message}, name, ignored);
}

dbc::MappedMessage Resolver::frame(config::Reader& at, std::string_view key, const dbc::Message& message) const {
  dbc::MappedMessage frame;
  frame.id = message.id + id_offset_;
  frame.extended = message.extended;
  frame.name = message.name;
  frame.length_bytes = message.length_bytes;
  if (frame.id > (frame.extended ? 0x1FFFFFFFu : 0x7FFu)) {
    at.reject(key, fmt::format("id of \"{}\" is out of range with id_offset", message.name));
  }
  if (frame.length_bytes == 0) at.reject(key, fmt::format("message \"{}\" has no bytes", message.name));
  return frame;
}

Conversion read_conversion(config::Reader& table, Dimension dimension) {
  constexpr config::Range kAny{-1e9, 1e9};
  Conversion conversion;
  conversion.dimension = dimension;
  if (dimension != Dimension::kNone && table.has("unit")) {
    conversion.unit = table.choice<double>("unit", units_of(dimension), 1.0);
  }
  conversion.factor = table.number("factor", kAny, 1.0);
  conversion.offset = table.number("offset", kAny, 0.0);
  if (conversion.factor == 0.0) table.reject("factor", "must not be 0");
  return conversion;
}

std::vector<dbc::SwitchCondition> map_conditions(const dbc::Message& message, const dbc::Signal& signal) {
  std::vector<dbc::SwitchCondition> conditions;
  for (const dbc::Signal* at = &signal; at->is_multiplexed();) {
    const dbc::Signal& switch_signal = message.signals[at->switch_index];
    conditions.push_back({switch_signal.can_signal(), at->switch_values});
    at = &switch_signal;
  }
  return conditions;
}

dbc::MappedSignal map_signal(const dbc::Message& message, const dbc::Signal& signal) {
  return {signal.can_signal(), 1.0, 0.0, map_conditions(message, signal)};
}

dbc::MappedSignal map_signal(const dbc::Message& message, const dbc::Signal& signal, const Conversion& conversion,
                             config::Reader& table) {
  dbc::MappedSignal mapped = map_signal(message, signal);
  double unit = 1.0;
  if (conversion.unit) {
    unit = *conversion.unit;
  } else if (conversion.dimension != Dimension::kNone) {
    const std::optional<double> stated = find_unit(signal.unit, conversion.dimension);
    if (!stated) {
      std::vector<std::string> words;
      for (const auto& [word, factor] : units_of(conversion.dimension)) words.emplace_back(word);
      table.reject(
          "", fmt::format("unit of \"{}\" is not in the DBC file; unit must be one of {}", signal.name, quoted(words)));
    }
    unit = stated.value_or(1.0);
  }
  mapped.factor = conversion.factor * unit;
  mapped.offset = conversion.offset * unit;
  return mapped;
}

dbc::MappedState read_state(config::Reader& table) {
  constexpr config::Range kCount{1, 64};
  constexpr config::Range kRaw{-9.2e18, 9.2e18};
  dbc::MappedState state;
  state.except = table.has("is_not");
  if (table.has("is") == table.has("is_not")) table.reject("", "needs either is or is_not: a list of raw values");
  state.values = table.integers("is", kCount, kRaw, {});
  std::vector<std::int64_t> excepted = table.integers("is_not", kCount, kRaw, {});
  if (state.except) state.values = std::move(excepted);
  return state;
}

Protection::Protection(config::Reader& table, std::size_t messages) : table_(table.table("e2e")) {
  using e2e::DataIdMode;
  using e2e::Profile;
  checksum_ = table.choice<dbc::Checksum>(
      "checksum", {{"none", dbc::Checksum::kNone}, {"toyota", dbc::Checksum::kToyota}}, dbc::Checksum::kNone);
  if (!table.has("e2e")) return;
  table_.require("profile");
  e2e_.profile = table_.choice<Profile>("profile",
                                        {{"P01", Profile::kP01},
                                         {"P02", Profile::kP02},
                                         {"P05", Profile::kP05},
                                         {"P11", Profile::kP11},
                                         {"P22", Profile::kP22}},
                                        Profile::kP01);
  e2e_.data_id_mode = table_.choice<DataIdMode>("data_id_mode",
                                                {{"both", DataIdMode::kBoth},
                                                 {"alternating", DataIdMode::kAlternating},
                                                 {"low", DataIdMode::kLow},
                                                 {"nibble", DataIdMode::kNibble}},
                                                DataIdMode::kBoth);
  e2e_.offset_bytes = static_cast<std::uint32_t>(table_.integer("offset_bytes", {0, 62}, 0));
  e2e_.max_delta_counter = static_cast<std::uint32_t>(table_.integer("max_delta_counter", {1, 254}, 1));
  const std::vector<std::int64_t> list = table_.integers("data_id_list", {16, 16}, {0, 255}, {});
  for (std::size_t i = 0; i < list.size(); ++i) e2e_.data_id_list[i] = static_cast<std::uint8_t>(list[i]);
  const auto one = static_cast<std::uint32_t>(table_.integer("data_id", {0, 0xFFFF}, 0));
  data_ids_.assign(messages, one);
  const auto size = static_cast<double>(messages);
  const std::vector<std::int64_t> several = table_.integers("data_ids", {size, size}, {0, 0xFFFF}, {});
  for (std::size_t i = 0; i < several.size(); ++i) data_ids_[i] = static_cast<std::uint32_t>(several[i]);
  const bool uses_list = e2e_.profile == Profile::kP02 || e2e_.profile == Profile::kP22;
  if (uses_list != table_.has("data_id_list")) {
    table_.reject("", "profiles P02 and P22 need data_id_list, the others data_id or data_ids");
  } else if (!uses_list && table_.has("data_id") == table_.has("data_ids")) {
    table_.reject("", "needs either data_id, or data_ids with one for each message");
  }
}

void Protection::apply(dbc::MappedMessage& message, std::size_t index) {
  message.checksum = checksum_;
  if (e2e_.profile == e2e::Profile::kNone || index >= data_ids_.size()) return;
  message.protection = e2e_;
  message.protection.data_id = data_ids_[index];
  if (const auto problem = e2e::validate(message.protection)) table_.reject("", *problem);
  if (e2e_.offset_bytes + e2e::header_bytes(e2e_.profile) > message.length_bytes) {
    table_.reject("", fmt::format("E2E header does not fit into \"{}\"", message.name));
  }
}

}  // namespace boresight::ingest
