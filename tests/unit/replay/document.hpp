// The worked examples of the Boresight service's definition, as bytes.
#pragma once

#include "tests/unit/document.hpp"

namespace boresight::replay {

/// The bytes of the example of that name; empty if there is none.
inline std::vector<std::uint8_t> document_example(const std::string& name) {
  return test::document_example("boresight_service.md", name);
}

}  // namespace boresight::replay
