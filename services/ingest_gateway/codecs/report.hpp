// Fault texts with numbers, without allocation.
#pragma once

#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Reports a fault with a printf format for its text, which is cut to 200 bytes.
[[gnu::format(printf, 3, 4)]] void report(DecoderOutput& output, Fault fault, const char* format, ...);

}  // namespace boresight::ingest
