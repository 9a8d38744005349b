#include "services/common/recording/candump.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace boresight::recording {

namespace {

constexpr std::uint8_t kNotHex = 0xFF;

constexpr std::array<std::uint8_t, 256> make_hex_table() {
  std::array<std::uint8_t, 256> table{};
  table.fill(kNotHex);
  for (std::size_t i = 0; i < 10; ++i) table['0' + i] = static_cast<std::uint8_t>(i);
  for (std::size_t i = 0; i < 6; ++i) table['A' + i] = table['a' + i] = static_cast<std::uint8_t>(10 + i);
  return table;
}
constexpr std::array<std::uint8_t, 256> kHex = make_hex_table();

std::uint8_t hex_value(char c) {
  return kHex[static_cast<unsigned char>(c)];
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

void skip_spaces(std::string_view& text) {
  std::size_t length = 0;
  while (length < text.size() && is_space(text[length])) ++length;
  text.remove_prefix(length);
}

std::string_view take_word(std::string_view& text) {
  skip_spaces(text);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

/// Copies `line` without the colour sequences (ESC [ … m) of `candump -c`.
std::string_view without_colours(std::string_view line, std::span<char> buffer) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\x1B' && i + 1 < line.size() && line[i + 1] == '[') {
      i = std::min(line.find('m', i), line.size());
    } else {
      buffer[size++] = line[i];
    }
  }
  return {buffer.data(), size};
}

/// ".123456" to nanoseconds; digits after the ninth are ignored.
bool parse_fraction(std::string_view text, std::int64_t& nanoseconds) {
  if (text.size() < 2 || text.front() != '.') return false;
  nanoseconds = 0;
  std::int64_t unit = 1'000'000'000;
  for (const char c : text.substr(1)) {
    if (!is_digit(c)) return false;
    unit /= 10;
    nanoseconds += unit * (c - '0');
  }
  return true;
}

/// Reads `digits` digits at `at`.
bool parse_number(std::string_view text, std::size_t at, std::size_t digits, std::int64_t& value) {
  value = 0;
  for (std::size_t i = at; i < at + digits; ++i) {
    if (i >= text.size() || !is_digit(text[i])) return false;
    value = value * 10 + (text[i] - '0');
  }
  return true;
}

/// Days since 1970-01-01 of a date in the Gregorian calendar.
std::int64_t days_from_civil(std::int64_t year, std::int64_t month, std::int64_t day) {
  // Years that begin in March put the leap day at the end; 719468 days lie between 0000-03-01 and 1970-01-01.
  if (month <= 2) --year;
  const std::int64_t shifted_month = (month + 9) % 12;
  const std::int64_t day_of_year = (153 * shifted_month + 2) / 5 + day - 1;
  return 365 * year + year / 4 - year / 100 + year / 400 + day_of_year - 719468;
}

/// "2006-11-20 20:20:26.123456" to nanoseconds since the epoch, read as UTC.
bool parse_date(std::string_view text, std::int64_t& stamp_ns) {
  std::int64_t year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, fraction = 0;
  if (text.size() < 21 || text[4] != '-' || text[7] != '-' || text[10] != ' ' || text[13] != ':' || text[16] != ':') {
    return false;
  }
  if (!parse_number(text, 0, 4, year) || !parse_number(text, 5, 2, month) || !parse_number(text, 8, 2, day) ||
      !parse_number(text, 11, 2, hour) || !parse_number(text, 14, 2, minute) || !parse_number(text, 17, 2, second) ||
      !parse_fraction(text.substr(19), fraction)) {
    return false;
  }
  // Second 60 is a leap second.
  if (year < 1970 || month < 1 || month > 12 || day < 1 || day > 31 || hour > 23 || minute > 59 || second > 60) {
    return false;
  }
  const std::int64_t seconds = ((days_from_civil(year, month, day) * 24 + hour) * 60 + minute) * 60 + second;
  if (seconds > kLastStamp_s) return false;
  stamp_ns = seconds * 1'000'000'000 + fraction;
  return true;
}

/// "1234.567890" to nanoseconds, exactly: a double would lose digits of epoch times.
bool parse_seconds(std::string_view text, std::int64_t& stamp_ns, std::size_t& digits) {
  digits = std::min(text.find('.'), text.size());
  std::int64_t seconds = 0;
  std::int64_t fraction = 0;
  if (digits == 0 || digits > 10 || !parse_number(text, 0, digits, seconds) ||
      !parse_fraction(text.substr(digits), fraction)) {
    return false;
  }
  if (seconds > kLastStamp_s) return false;
  stamp_ns = seconds * 1'000'000'000 + fraction;
  return true;
}

/// The part before the data, common to both formats.
enum class IdKind : std::uint8_t { kBad, kData, kError };

IdKind parse_id(std::string_view digits, Frame& frame) {
  if (digits.size() != 3 && digits.size() != 8) return IdKind::kBad;
  std::uint32_t id = 0;
  for (const char c : digits) {
    const std::uint8_t value = hex_value(c);
    if (value == kNotHex) return IdKind::kBad;
    id = id << 4 | value;
  }
  frame.can_extended = digits.size() == 8;
  frame.can_id = id;
  // The id of an error frame contains the kernel's error flag, bit 29.
  if (frame.can_extended && id >> 29 == 1) return IdKind::kError;
  return id <= (frame.can_extended ? 0x1FFFFFFFu : 0x7FFu) ? IdKind::kData : IdKind::kBad;
}

bool is_fd_length(std::size_t length) {
  return length <= 8 || length == 12 || length == 16 || length == 20 || length == 24 || length == 32 || length == 48 ||
         length == 64;
}

/// Bytes "0102" or "01.02"; false if they are not hexadecimal or more than `max_bytes`.
bool parse_bytes(std::string_view digits, std::size_t max_bytes, CandumpLine& out) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    if (digits[i] == '.') {  // cansend's notation
      --i;
      continue;
    }
    if (i + 1 == digits.size() || count == max_bytes) return false;
    const std::uint8_t high = hex_value(digits[i]);
    const std::uint8_t low = hex_value(digits[i + 1]);
    if ((high | low) > 0x0F) return false;
    out.bytes[count++] = static_cast<std::uint8_t>(high << 4 | low);
  }
  out.frame.payload = {out.bytes.data(), count};
  return true;
}

/// Removes "_9" … "_F", the raw data length code of a classic frame with eight bytes.
void cut_raw_length_code(std::string_view& digits) {
  if (digits.size() < 3 || digits[digits.size() - 2] != '_') return;
  const std::uint8_t code = hex_value(digits.back());
  if (code != kNotHex && code > 8) digits.remove_suffix(2);
}

CandumpResult parse_log_body(std::string_view data, std::size_t hash, std::string_view rest, CandumpLine& out) {
  std::string_view digits = data.substr(hash + 1);
  const IdKind id = parse_id(data.substr(0, hash), out.frame);
  // CAN XL is `<id>#<flags>:<type>:<acceptance>#<data>`; no other frame has a colon.
  if (digits.size() > 2 && digits[2] == ':') return CandumpResult::kCanXl;
  if (id == IdKind::kBad) return CandumpResult::kBadId;
  if (!digits.empty() && digits.front() == '#') {
    if (digits.size() < 2 || hex_value(digits[1]) == kNotHex) return CandumpResult::kBadData;
    out.frame.kind = FrameKind::kCanFd;
    out.frame.can_fd_flags = hex_value(digits[1]);
    if (!parse_bytes(digits.substr(2), 64, out) || !is_fd_length(out.frame.payload.size())) {
      return CandumpResult::kBadData;
    }
  } else if (!digits.empty() && (digits.front() == 'R' || digits.front() == 'r')) {
    cut_raw_length_code(digits);
    out.frame.can_remote = true;
    if (digits.size() > 2 || (digits.size() == 2 && (digits[1] < '0' || digits[1] > '8'))) {
      return CandumpResult::kBadData;
    }
  } else {
    cut_raw_length_code(digits);
    if (!parse_bytes(digits, 8, out)) return CandumpResult::kBadData;
  }
  const std::string_view direction = take_word(rest);
  skip_spaces(rest);
  const bool known = direction.empty() || direction == "R" || direction == "T";
  if (!known || !rest.empty()) return CandumpResult::kTrailingText;
  return id == IdKind::kError ? CandumpResult::kErrorFrame : CandumpResult::kFrame;
}

/// "[8]" classic, "[08]" FD, "{C}" classic with a raw data length code.
bool parse_length(std::string_view word, std::size_t& length, FrameKind& kind) {
  if (word.size() < 3) return false;
  const std::string_view inner = word.substr(1, word.size() - 2);
  if (word.front() == '{' && word.back() == '}' && inner.size() == 1) {
    length = 8;
    kind = FrameKind::kCan;
    return hex_value(inner[0]) != kNotHex && hex_value(inner[0]) > 8;
  }
  if (word.front() != '[' || word.back() != ']') return false;
  std::int64_t value = 0;
  if (inner.size() > 2 || !parse_number(inner, 0, inner.size(), value)) return false;
  length = static_cast<std::size_t>(value);
  kind = inner.size() == 2 ? FrameKind::kCanFd : FrameKind::kCan;
  return kind == FrameKind::kCanFd ? is_fd_length(length) : length <= 8;
}

/// One byte of the console: two hexadecimal digits, or eight binary ones (`candump -i`).
bool take_console_byte(std::string_view& text, std::uint8_t& byte) {
  std::size_t length = 0;
  while (length < text.size() && length <= 8 && !is_space(text[length]) && text[length] != '`') ++length;
  byte = 0;
  for (std::size_t i = 0; i < length; ++i) {
    const std::uint8_t digit = hex_value(text[i]);
    if (digit == kNotHex || (length == 8 && digit > 1)) return false;
    byte = static_cast<std::uint8_t>(byte << (length == 8 ? 1 : 4) | digit);
  }
  text.remove_prefix(length);
  return length == 2 || length == 8;
}

bool is_ascii_column(std::string_view text) {
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text.size() >= 2 && (text.front() == '\'' || text.front() == '`') && text.front() == text.back();
}

CandumpResult parse_console_body(std::string_view id_word, std::string_view rest, CandumpLine& out) {
  if (id_word == "RX" || id_word == "TX") {  // candump -x: direction, bit rate switch, error state
    for (const char flag : {'B', 'E'}) {
      const std::string_view word = take_word(rest);
      if (word.size() != 1 || (word[0] != '-' && word[0] != flag)) return CandumpResult::kTrailingText;
      if (word[0] == flag) {
        out.frame.can_fd_flags = static_cast<std::uint8_t>(out.frame.can_fd_flags | (flag == 'B' ? 1 : 2));
      }
    }
    id_word = take_word(rest);
  }
  const IdKind id = parse_id(id_word, out.frame);
  const std::string_view length_word = take_word(rest);
  if (length_word.size() == 6 && length_word.front() == '[') return CandumpResult::kCanXl;
  if (id == IdKind::kBad) return CandumpResult::kBadId;
  std::size_t length = 0;
  if (!parse_length(length_word, length, out.frame.kind)) return CandumpResult::kBadData;
  skip_spaces(rest);
  constexpr std::string_view kRemote = "remote request";
  if (out.frame.kind == FrameKind::kCan && rest.starts_with(kRemote)) {
    out.frame.can_remote = true;
    rest.remove_prefix(kRemote.size());
    skip_spaces(rest);
    if (!rest.empty()) return CandumpResult::kTrailingText;
    return id == IdKind::kError ? CandumpResult::kErrorFrame : CandumpResult::kFrame;
  }
  bool swapped = false;
  for (std::size_t i = 0; i < length; ++i) {
    if (i > 0 && !rest.empty() && rest.front() == '`') {  // candump -S: last byte first
      swapped = true;
      rest.remove_prefix(1);
    }
    skip_spaces(rest);
    if (!take_console_byte(rest, out.bytes[i])) return CandumpResult::kBadData;
  }
  if (swapped) std::reverse(out.bytes.begin(), out.bytes.begin() + static_cast<std::ptrdiff_t>(length));
  out.frame.payload = {out.bytes.data(), length};
  skip_spaces(rest);
  if (id == IdKind::kError && rest.starts_with("ERRORFRAME")) return CandumpResult::kErrorFrame;
  if (!rest.empty() && !is_ascii_column(rest)) return CandumpResult::kTrailingText;
  return id == IdKind::kError ? CandumpResult::kErrorFrame : CandumpResult::kFrame;
}

}  // namespace

std::string_view describe(CandumpResult result) {
  switch (result) {
    case CandumpResult::kFrame:
      return "frame";
    case CandumpResult::kEmpty:
      return "blank";
    case CandumpResult::kErrorFrame:
      return "error frame";
    case CandumpResult::kDropCount:
      return "candump reports that the kernel dropped frames here";
    case CandumpResult::kCanXl:
      return "CAN XL is not supported";
    case CandumpResult::kNoStamp:
      return "no time stamp; record with candump -l, -L or -ta";
    case CandumpResult::kBadStamp:
      return "time stamp is neither (seconds.fraction) nor (YYYY-MM-DD hh:mm:ss.fraction), from 1970 to March 2255";
    case CandumpResult::kBadName:
      return "interface name missing, longer than 15 characters or with control characters";
    case CandumpResult::kBadId:
      return "CAN id is not 3 (up to 7FF) or 8 (up to 1FFFFFFF) hexadecimal digits";
    case CandumpResult::kBadData:
      return "data are not 0 … 8 (FD: 0 … 64) bytes in hexadecimal, or differ from the stated number";
    case CandumpResult::kTrailingText:
      return "text after the data";
    case CandumpResult::kTooLong:
      return "longer than any line of candump";
  }
  return "unknown";
}

bool is_problem(CandumpResult result) {
  return result != CandumpResult::kFrame && result != CandumpResult::kEmpty && result != CandumpResult::kErrorFrame;
}

CandumpResult parse_candump_line(std::string_view line, CandumpLine& out) {
  out.frame = Frame{};
  out.stamp = CandumpStamp::kAbsolute;
  if (line.size() > kMaxCandumpLine) return CandumpResult::kTooLong;
  std::array<char, kMaxCandumpLine> plain;
  std::string_view rest = line;
  if (!line.empty() && std::memchr(line.data(), '\x1B', line.size()) != nullptr) rest = without_colours(line, plain);
  if (rest.size() > 1 && rest[0] == '\t' && rest[1] >= 'a' && rest[1] <= 'z') return CandumpResult::kEmpty;
  skip_spaces(rest);
  if (rest.empty()) return CandumpResult::kEmpty;
  if (rest.starts_with("DROPCOUNT: ")) return CandumpResult::kDropCount;

  // A line without a time stamp is of no use.
  if (rest.front() != '(') return CandumpResult::kNoStamp;
  const std::size_t close = rest.find(')');
  if (close == std::string_view::npos) return CandumpResult::kBadStamp;
  const std::string_view stamp = rest.substr(1, close - 1);
  std::size_t second_digits = 0;
  const bool is_date = parse_date(stamp, out.frame.stamp_ns);
  if (!is_date && !parse_seconds(stamp, out.frame.stamp_ns, second_digits)) return CandumpResult::kBadStamp;
  rest.remove_prefix(close + 1);
  const std::string_view name = take_word(rest);
  // A zero byte would truncate the name.
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; };
  if (name.empty() || name.size() > 15 || std::any_of(name.begin(), name.end(), is_control)) {
    return CandumpResult::kBadName;
  }
  out.frame.set_interface(name);
  const std::string_view word = take_word(rest);
  const std::size_t hash = word.find('#');
  if (hash != std::string_view::npos) return parse_log_body(word, hash, rest, out);
  // The console pads seconds since the epoch to ten digits and relative ones to three.
  if (!is_date && second_digits < 10) out.stamp = CandumpStamp::kRelative;
  return parse_console_body(word, rest, out);
}

}  // namespace boresight::recording
