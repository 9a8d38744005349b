// One end-to-end check; passes its statistics on.
#pragma once

#include <cstdint>
#include <span>

#include "services/common/e2e/checker.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Checks one message and reports the change of the checker's statistics.
[[nodiscard]] inline e2e::Status check_protection(e2e::Checker& checker, std::span<const std::uint8_t> data,
                                                  DecoderOutput& output) {
  const auto wrong = [](const e2e::Statistics& s) {
    return s.wrong_crc + s.wrong_length + s.wrong_data_id + s.wrong_sequence;
  };
  const e2e::Statistics before = checker.statistics();
  const e2e::Status status = checker.check(data);
  const e2e::Statistics& after = checker.statistics();
  output.count_e2e({.lost = after.lost - before.lost,
                    .repeated = after.repeated - before.repeated,
                    .wrong = wrong(after) - wrong(before)});
  return status;
}

}  // namespace boresight::ingest
