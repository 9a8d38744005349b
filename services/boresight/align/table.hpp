// A result for the terminal.
#pragma once

#include <string>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// A line on the drive, one a radar, one on what they share; what the data do not support is "not observable".
[[nodiscard]] std::string to_table(const Result& result);

}  // namespace boresight::align
