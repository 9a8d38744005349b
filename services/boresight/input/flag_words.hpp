// The flags of a detection as a word of a table.
#pragma once

#include <array>
#include <string_view>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::input {

/// The index is the set of detection_flag bits.
inline constexpr std::array<std::string_view, 8> kFlagWords = {
    "",         "invalid",          "ambiguous",          "invalid+ambiguous",
    "unusable", "invalid+unusable", "ambiguous+unusable", "invalid+ambiguous+unusable"};
static_assert(detection_flag::kInvalid == 1 && detection_flag::kAmbiguous == 2 && detection_flag::kUnusable == 4);

}  // namespace boresight::input
