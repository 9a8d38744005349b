// A result as a table for the terminal.
#pragma once

#include <string>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// A line for the drive, a line for each radar, and a line for the shared parameters. A parameter that the data do not
/// support is "not observable".
[[nodiscard]] std::string to_table(const Result& result);

}  // namespace boresight::align
