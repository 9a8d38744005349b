// Status of services received by DDS, as lines for people or for programs.
#pragma once

#include <string>

#include "generated/service_status.h"

namespace boresight::diagnostics_text {

/// "12:34:56.7 tracker              alive  running  pid 123  20.0 Hz  …"; no line feed at the end.
[[nodiscard]] std::string to_line(const diagnostics::ServiceStatus& status);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const diagnostics::ServiceStatus& status);

}  // namespace boresight::diagnostics_text
