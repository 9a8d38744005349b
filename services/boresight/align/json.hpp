// A result as JSON; config/schema/json.md describes the keys.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// Origin of a result.
struct Provenance {
  std::string tool_version;
  std::string drive, ego, vehicle, config, truth;  ///< files; "" where none was given
  std::vector<std::string> recordings;
  std::uint64_t lines = 0, bad_lines = 0, dropped_detections = 0;
};

[[nodiscard]] std::string to_json(const Result& result, const Provenance& provenance);
[[nodiscard]] const char* name_of(AlignmentState state);

}  // namespace boresight::align
