#include "services/ingest_gateway/codecs/report.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>

namespace boresight::ingest {

void report(DecoderOutput& output, Fault fault, const char* format, ...) {
  std::array<char, 200> text;
  std::va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  output.fault(fault, {text.data(), std::min(static_cast<std::size_t>(std::max(length, 0)), text.size() - 1)});
}

}  // namespace boresight::ingest
