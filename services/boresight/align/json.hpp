// A result as JSON; the schema is in services/boresight/README.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// Where a result comes from.
struct Provenance {
  std::string tool_version;
  std::string drive, ego, vehicle, config, truth;  ///< files; "" where none was given
  std::vector<std::string> recordings;
  std::uint64_t lines = 0, bad_lines = 0, dropped_detections = 0;
};

[[nodiscard]] std::string to_json(const Result& result, const Provenance& provenance);
[[nodiscard]] const char* name_of(AlignmentState state);

}  // namespace boresight::align
