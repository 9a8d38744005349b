// The version of this software.
#pragma once

#include <string_view>

namespace boresight::runtime {

[[nodiscard]] std::string_view software_version();

}  // namespace boresight::runtime
