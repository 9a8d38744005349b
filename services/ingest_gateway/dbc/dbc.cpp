#include "services/ingest_gateway/dbc/dbc.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "services/ingest_gateway/dbc/scanner.hpp"

namespace boresight::ingest::dbc {

namespace {

constexpr std::uint64_t kExtendedBit = 0x8000'0000;
constexpr std::uint64_t kNotOnTheBusBit = 0x4000'0000;
constexpr std::uint64_t kMaxStandardId = 0x7FF;
constexpr std::uint64_t kMaxExtendedId = 0x1FFF'FFFF;
constexpr std::uint64_t kMaxLength_bytes = 64;
constexpr std::uint64_t kMaxRanges = 64;

class Parser {
 public:
  Parser(std::string_view text, std::string_view file_name) : text_(text), file_name_(file_name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }

  Database run() {
    while (position_ < text_.size()) {
      ++line_;
      take_line(next_line());
    }
    for (std::size_t i = 0; i < database_.messages.size(); ++i) resolve_multiplexing(i);
    drop_unresolved();
    return std::move(database_);
  }

 private:
  struct Place {
    std::size_t message = 0, signal = 0;
  };
  struct Extended {
    std::string_view switch_name;
    std::vector<ValueRange> values;
    std::size_t line = 0;
  };
  using SignalKey = std::pair<std::size_t, std::string_view>;

  std::string_view next_line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    line_begin_ = position_;
    position_ = std::min(end + 1, text_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void problem(std::size_t line, std::string_view what) {
    if (database_.problems.size() >= kMaxProblems) return;
    const bool is_last = database_.problems.size() + 1 == kMaxProblems;
    database_.problems.push_back(std::string(file_name_) + ":" + std::to_string(line) + ": " +
                                 std::string(is_last ? "further problems are not listed" : what));
  }
  void problem(std::string_view what) { problem(line_, what); }

  void take_line(std::string_view line) {
    Scanner scanner(line);
    if (scanner.at_end()) return;
    const std::string_view keyword = scanner.take_name();
    // The keywords below NS_ are a table of contents: one per line.
    if (scanner.at_end()) return;
    if (keyword == "BO_") {
      take_message(scanner);
    } else if (keyword == "SG_") {
      take_signal(scanner);
    } else if (keyword == "SIG_VALTYPE_") {
      take_kind(scanner);
    } else if (keyword == "SG_MUL_VAL_") {
      take_extended_multiplexing(scanner);
    } else {
      // Signals after an invalid BO_ must not be added to the previous message.
      current_ = std::nullopt;
      skip_signals_ = false;
      skip_strings(line);
    }
  }

  /// Skips the lines of a string in an ignored statement; such a string may have many lines.
  void skip_strings(std::string_view line) {
    const std::size_t first_line = line_;
    std::size_t at = line_begin_;
    std::size_t end = line_begin_ + line.size();
    while (true) {
      const std::size_t in_line = text_.substr(at, end - at).find('"');
      if (in_line == std::string_view::npos) break;
      const std::size_t open = at + in_line;
      const std::size_t close = closing_quote(open);
      if (close == std::string_view::npos) {
        problem(first_line, "string is not closed");
        return;  // continue with the next line
      }
      at = close + 1;
      while (position_ <= close) {
        ++line_;
        end = line_begin_ = position_;
        end += next_line().size();
      }
    }
  }

  std::size_t closing_quote(std::size_t open) {
    if (is_last_unclosed_) return std::string_view::npos;
    std::size_t at = text_.find('"', open + 1);
    while (at != std::string_view::npos && text_[at - 1] == '\\') at = text_.find('"', at + 1);
    // No later line closes a string either; avoids a second search.
    is_last_unclosed_ = at == std::string_view::npos;
    return at;
  }

  void take_message(Scanner& scanner) {
    current_ = std::nullopt;
    skip_signals_ = true;  // of an ignored message
    const auto id = scanner.take_unsigned();
    const std::string_view name = scanner.take_name();
    const bool has_colon = scanner.take(':');
    const auto length = scanner.take_unsigned();
    if (!id || name.empty() || !has_colon || !length) return problem("BO_ must be: BO_ ID NAME: LENGTH SENDER");
    if ((*id & kNotOnTheBusBit) != 0) return;
    const bool extended = (*id & kExtendedBit) != 0;
    const std::uint64_t bus_id = extended ? *id & ~kExtendedBit : *id;
    if (bus_id > (extended ? kMaxExtendedId : kMaxStandardId)) {
      return problem("message id is out of range; allowed: 0 … 0x7FF, or with bit 31 set 0 … 0x1FFFFFFF");
    }
    if (*length > kMaxLength_bytes) return problem("message is too long; allowed: 0 … 64 bytes");
    if (!messages_by_id_.emplace(*id, database_.messages.size()).second) {
      return problem("message id occurs twice; the first message counts");
    }
    if (!message_names_.insert(name).second) {
      messages_by_id_.erase(*id);
      return problem("message name occurs twice; the first message counts");
    }
    skip_signals_ = false;
    current_ = database_.messages.size();
    Message& message = database_.messages.emplace_back();
    message.id = static_cast<std::uint32_t>(bus_id);
    message.extended = extended;
    message.name = name;
    message.length_bytes = static_cast<std::uint16_t>(*length);
  }

  void take_signal(Scanner& scanner) {
    if (!current_) {
      if (!skip_signals_) problem("signal without a message");
      return;
    }
    const std::string_view name = scanner.take_name();
    Signal signal;
    if (name.empty() || !take_role(scanner, signal) || !take_layout(scanner, signal)) {
      return problem("SG_ must be: SG_ NAME [M|m<N>] : START|LENGTH@ORDER SIGN (FACTOR,OFFSET) [MIN|MAX] \"UNIT\" ...");
    }
    Message& message = database_.messages[*current_];
    if (signal.factor == 0.0) return problem("factor of a signal must not be 0");
    if (!wire::fits(signal.can_signal(), message.length_bytes)) return problem("signal reaches beyond its message");
    if (!signals_.emplace(SignalKey{*current_, name}, Place{*current_, message.signals.size()}).second) {
      return problem("signal name occurs twice in a message; the first signal counts");
    }
    signal.name = name;
    message.signals.push_back(std::move(signal));
    lines_.resize(database_.messages.size());
    lines_[*current_].push_back(line_);
  }

  static bool take_role(Scanner& scanner, Signal& signal) {
    if (scanner.take(':')) return true;
    std::string_view word = scanner.take_name();
    if (word == "M") {
      signal.role = MultiplexRole::kSwitch;
      return scanner.take(':');
    }
    if (!word.starts_with('m')) return false;
    word.remove_prefix(1);
    Scanner number(word);
    const auto value = number.take_unsigned();
    if (!value) return false;
    signal.role = MultiplexRole::kValue;
    if (number.take('M')) signal.role = MultiplexRole::kValueAndSwitch;
    signal.switch_values = {{*value, *value}};
    return number.at_end() && scanner.take(':');
  }

  static bool take_layout(Scanner& scanner, Signal& signal) {
    const auto start = scanner.take_unsigned();
    if (!start || !scanner.take('|')) return false;
    const auto length = scanner.take_unsigned();
    if (!length || !scanner.take('@')) return false;
    const auto order = scanner.take_unsigned();
    if (!order || *order > 1) return false;
    signal.is_signed = scanner.take('-');
    if (!signal.is_signed && !scanner.take('+')) return false;
    if (!scanner.take('(')) return false;
    const auto factor = scanner.take_number();
    if (!factor || !scanner.take(',')) return false;
    const auto offset = scanner.take_number();
    if (!offset || !scanner.take(')') || !scanner.take('[')) return false;
    const auto minimum = scanner.take_number();
    if (!minimum || !scanner.take('|')) return false;
    const auto maximum = scanner.take_number();
    if (!maximum || !scanner.take(']')) return false;
    const auto unit = scanner.take_string();
    if (!unit) return false;
    // A value too large for the type is too large for any message: a length of 0 makes fits() fail.
    const bool is_possible = *start < kMaxLength_bytes * 8 && *length <= 64;
    signal.start_bit = static_cast<std::uint16_t>(is_possible ? *start : 0);
    signal.length = static_cast<std::uint8_t>(is_possible ? *length : 0);
    signal.order = *order == 0 ? wire::ByteOrder::kMotorola : wire::ByteOrder::kIntel;
    signal.factor = *factor;
    signal.offset = *offset;
    signal.minimum = *minimum;
    signal.maximum = *maximum;
    signal.unit = *unit;
    return true;
  }

  /// The signal that a later statement refers to. nullptr without a problem for a message that is on no bus.
  Signal* take_signal_reference(Scanner& scanner, Place& place) {
    const auto id = scanner.take_unsigned();
    const std::string_view name = scanner.take_name();
    if (!id || name.empty()) {
      problem("message id and signal name are missing");
      return nullptr;
    }
    if ((*id & kNotOnTheBusBit) != 0) return nullptr;
    const auto message = messages_by_id_.find(*id);
    const auto signal =
        message == messages_by_id_.end() ? signals_.end() : signals_.find(SignalKey{message->second, name});
    if (signal == signals_.end()) {
      problem("there is no such signal");
      return nullptr;
    }
    place = signal->second;
    return &database_.messages[place.message].signals[place.signal];
  }

  void take_kind(Scanner& scanner) {
    Place place;
    Signal* const signal = take_signal_reference(scanner, place);
    if (signal == nullptr) return;
    static_cast<void>(scanner.take(':'));  // some tools omit it
    const auto kind = scanner.take_unsigned();
    if (!kind || *kind > 2) return problem("SIG_VALTYPE_ must be: 0 for an integer, 1 for a float, 2 for a double");
    if (*kind == 0) return;
    if (signal->length != (*kind == 1 ? 32 : 64)) return problem("a float has 32 bits, a double 64");
    signal->kind = *kind == 1 ? wire::SignalKind::kFloat32 : wire::SignalKind::kFloat64;
  }

  void take_extended_multiplexing(Scanner& scanner) {
    Place place;
    Signal* const signal = take_signal_reference(scanner, place);
    if (signal == nullptr) return;
    Extended extended{scanner.take_name(), {}, line_};
    do {
      const auto first = scanner.take_unsigned();
      const bool has_dash = scanner.take('-');
      const auto last = scanner.take_unsigned();
      if (extended.switch_name.empty() || !first || !has_dash || !last || *first > *last ||
          extended.values.size() == kMaxRanges) {
        return problem(
            "SG_MUL_VAL_ must be: SG_MUL_VAL_ ID SIGNAL SWITCH FIRST-LAST[, FIRST-LAST …]; at most 64 ranges");
      }
      extended.values.push_back({*first, *last});
    } while (scanner.take(','));
    if (!signal->is_multiplexed()) return problem("signal is not multiplexed (m<N>)");
    if (!extended_
             .emplace(SignalKey{place.message, signals_.find({place.message, signal->name})->first.second},
                      std::move(extended))
             .second) {
      problem("signal has two SG_MUL_VAL_; the first counts");
    }
  }

  /// Finds each multiplexed signal's switch: the named one, or the message's only one.
  void resolve_multiplexing(std::size_t m) {
    Message& message = database_.messages[m];
    std::size_t only_switch = kNoSignal, switches = 0;
    for (std::size_t s = 0; s < message.signals.size(); ++s) {
      if (message.signals[s].role != MultiplexRole::kSwitch) continue;
      only_switch = s;
      ++switches;
    }
    for (std::size_t s = 0; s < message.signals.size(); ++s) {
      Signal& signal = message.signals[s];
      if (!signal.is_multiplexed()) continue;
      const auto extended = extended_.find(SignalKey{m, signal.name});
      if (extended == extended_.end()) {
        if (switches == 1) signal.switch_index = only_switch;
        if (switches != 1) problem(lines_[m][s], "multiplexed signal, but its message has no or several switches");
        continue;
      }
      const auto found = signals_.find(SignalKey{m, extended->second.switch_name});
      if (found == signals_.end() || !message.signals[found->second.signal].is_switch()) {
        problem(extended->second.line, "there is no such switch in the message");
        continue;
      }
      signal.switch_index = found->second.signal;
      signal.switch_values = std::move(extended->second.values);
    }
  }

  /// Number of switches that a signal depends on; more than allowed for a cycle of switches.
  static std::size_t switches_above(const Message& message, const Signal& signal) {
    std::size_t count = 0;
    for (const Signal* at = &signal; at->is_multiplexed() && count <= kMaxSwitches; ++count) {
      if (at->switch_index == kNoSignal) return kMaxSwitches + 1;
      at = &message.signals[at->switch_index];
    }
    return count;
  }

  /// Removes signals with an unknown condition, and the signals that depend on them.
  void drop_unresolved() {
    for (std::size_t m = 0; m < database_.messages.size(); ++m) {
      Message& message = database_.messages[m];
      std::vector<std::size_t> new_index(message.signals.size(), kNoSignal);
      std::vector<Signal> kept;
      for (std::size_t s = 0; s < message.signals.size(); ++s) {
        if (switches_above(message, message.signals[s]) > kMaxSwitches) {
          if (message.signals[s].switch_index != kNoSignal) {
            problem(lines_[m][s],
                    "signal depends on more than 4 switches, on itself or on a switch without a valid condition");
          }
          continue;
        }
        new_index[s] = kept.size();
        kept.push_back(message.signals[s]);
      }
      for (Signal& signal : kept) {
        if (signal.switch_index != kNoSignal) signal.switch_index = new_index[signal.switch_index];
      }
      message.signals = std::move(kept);
    }
  }

  std::string_view text_;
  std::string_view file_name_;
  std::size_t position_ = 0, line_begin_ = 0, line_ = 0;
  bool is_last_unclosed_ = false;
  Database database_;
  std::optional<std::size_t> current_;  // message that signals belong to
  bool skip_signals_ = false;
  std::map<std::uint64_t, std::size_t> messages_by_id_;  // by the id as written
  std::set<std::string_view> message_names_;
  std::map<SignalKey, Place> signals_;
  std::map<SignalKey, Extended> extended_;
  std::vector<std::vector<std::size_t>> lines_;  // of each signal
};

}  // namespace

const Signal* Message::find(std::string_view signal) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const Signal& s) { return s.name == signal; });
  return found == signals.end() ? nullptr : &*found;
}

const Message* Database::find(std::string_view message) const {
  const auto found =
      std::find_if(messages.begin(), messages.end(), [&](const Message& m) { return m.name == message; });
  return found == messages.end() ? nullptr : &*found;
}

Database parse_dbc(std::string_view text, std::string_view file_name) {
  return Parser(text, file_name).run();
}

}  // namespace boresight::ingest::dbc
