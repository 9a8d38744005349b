// What every file states of a radar in the same way. For sources that write JSON, so it includes the library.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/run/words.hpp"

namespace boresight::run {

/// The object of a radar, begun: "id" and "name".
[[nodiscard]] inline json::Value radar_object(std::uint32_t id, const std::string& name) {
  json::Value value;
  value["id"] = id;
  value["name"] = name;
  return value;
}

/// Numbers of detections by Provenance, each under its word.
[[nodiscard]] inline json::Value counts_by_origin(const std::array<std::uint64_t, kOriginWords.size()>& counts) {
  json::Value value;
  for (std::size_t i = 0; i < counts.size(); ++i) value[std::string(kOriginWords[i])] = counts[i];
  return value;
}

}  // namespace boresight::run
