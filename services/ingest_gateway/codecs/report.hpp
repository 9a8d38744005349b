// Reasons with numbers in them, without allocation.
#pragma once

#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Reports a fault whose reason is printed as by printf; cut to 200 bytes.
[[gnu::format(printf, 3, 4)]] void report(DecoderOutput& output, Fault fault, const char* format, ...);

}  // namespace boresight::ingest
