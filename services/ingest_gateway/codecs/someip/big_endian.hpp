// The functions of codecs/big_endian.hpp by the names that this room uses.
#pragma once

#include "services/ingest_gateway/codecs/big_endian.hpp"

namespace boresight::ingest::someip {

using ingest::read_f32;
using ingest::read_u16;
using ingest::read_u24;
using ingest::read_u32;
using ingest::write_f32;
using ingest::write_u16;
using ingest::write_u24;
using ingest::write_u32;

}  // namespace boresight::ingest::someip
