#include "services/common/recording/candump.hpp"

namespace boresight::recording {

namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

void skip_spaces(std::string_view& text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
}

std::string_view take_word(std::string_view& text) {
  skip_spaces(text);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

/// "(1234.567890)" to nanoseconds, exactly: a double would lose digits of epoch times.
bool parse_stamp(std::string_view word, std::int64_t& stamp_ns) {
  if (word.size() < 4 || word.front() != '(' || word.back() != ')') return false;
  word = word.substr(1, word.size() - 2);
  std::int64_t seconds = 0;
  std::int64_t fraction = 0;
  std::int64_t unit = 1'000'000'000;
  std::size_t digits_before = 0;
  bool after_point = false;
  for (const char c : word) {
    if (c == '.' && !after_point) {
      after_point = true;
    } else if (c < '0' || c > '9') {
      return false;
    } else if (!after_point) {
      if (++digits_before > 10) return false;
      seconds = seconds * 10 + (c - '0');
    } else if (unit > 1) {
      unit /= 10;
      fraction += unit * (c - '0');
    }
  }
  // Beyond the year 2262 nanoseconds do not fit.
  if (digits_before == 0 || !after_point || seconds > 9'000'000'000) return false;
  stamp_ns = seconds * 1'000'000'000 + fraction;
  return true;
}

bool parse_id(std::string_view digits, Frame& frame) {
  if (digits.size() != 3 && digits.size() != 8) return false;
  std::uint32_t id = 0;
  for (const char c : digits) {
    const int value = hex_value(c);
    if (value < 0) return false;
    id = id * 16 + static_cast<std::uint32_t>(value);
  }
  frame.can_extended = digits.size() == 8;
  frame.can_id = id;
  return id <= (frame.can_extended ? 0x1FFFFFFFu : 0x7FFu);
}

/// Number of bytes, or −1.
int parse_bytes(std::string_view digits, std::size_t max_bytes, std::array<std::uint8_t, 64>& bytes) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    if (digits[i] == '.') {  // candump may separate bytes by points
      --i;
      continue;
    }
    const int high = hex_value(digits[i]);
    const int low = i + 1 < digits.size() ? hex_value(digits[i + 1]) : -1;
    if (high < 0 || low < 0 || count == max_bytes) return -1;
    bytes[count++] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return static_cast<int>(count);
}

bool is_fd_length(int length) {
  return (length >= 0 && length <= 8) || length == 12 || length == 16 || length == 20 || length == 24 || length == 32 ||
         length == 48 || length == 64;
}

}  // namespace

std::string_view describe(CandumpResult result) {
  switch (result) {
    case CandumpResult::kFrame:
      return "frame";
    case CandumpResult::kEmpty:
      return "blank";
    case CandumpResult::kBadStamp:
      return "time stamp is not (seconds.fraction)";
    case CandumpResult::kBadName:
      return "interface name missing or longer than 15 characters";
    case CandumpResult::kBadId:
      return "CAN id is not 3 (up to 7FF) or 8 (up to 1FFFFFFF) hexadecimal digits before #";
    case CandumpResult::kBadData:
      return "data are not 0 … 8 (FD: 0 … 64) bytes in hexadecimal";
    case CandumpResult::kTrailingText:
      return "text after the data";
  }
  return "unknown";
}

CandumpResult parse_candump_line(std::string_view line, Frame& frame, std::array<std::uint8_t, 64>& bytes) {
  frame = Frame{};
  std::string_view rest = line;
  const std::string_view stamp = take_word(rest);
  if (stamp.empty()) return CandumpResult::kEmpty;
  if (!parse_stamp(stamp, frame.stamp_ns)) return CandumpResult::kBadStamp;
  const std::string_view name = take_word(rest);
  if (name.empty() || name.size() > 15) return CandumpResult::kBadName;
  frame.set_interface(name);
  const std::string_view data = take_word(rest);
  const std::size_t hash = data.find('#');
  if (hash == std::string_view::npos || !parse_id(data.substr(0, hash), frame)) return CandumpResult::kBadId;
  std::string_view digits = data.substr(hash + 1);
  if (!digits.empty() && digits.front() == '#') {
    if (digits.size() < 2 || hex_value(digits[1]) < 0) return CandumpResult::kBadData;
    frame.kind = FrameKind::kCanFd;
    const int length = parse_bytes(digits.substr(2), 64, bytes);
    if (!is_fd_length(length)) return CandumpResult::kBadData;
    frame.payload = {bytes.data(), static_cast<std::size_t>(length)};
  } else if (!digits.empty() && (digits.front() == 'R' || digits.front() == 'r')) {
    frame.can_remote = true;
    if (digits.size() > 2 || (digits.size() == 2 && (digits[1] < '0' || digits[1] > '8'))) {
      return CandumpResult::kBadData;
    }
  } else {
    const int length = parse_bytes(digits, 8, bytes);
    if (length < 0) return CandumpResult::kBadData;
    frame.payload = {bytes.data(), static_cast<std::size_t>(length)};
  }
  const std::string_view direction = take_word(rest);
  skip_spaces(rest);
  const bool known = direction.empty() || direction == "R" || direction == "T";
  return known && rest.empty() ? CandumpResult::kFrame : CandumpResult::kTrailingText;
}

}  // namespace boresight::recording
