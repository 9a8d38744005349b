// config/services/object_classes.toml → ObjectClassTable.
#pragma once

#include "services/common/extended_object/object_classes.hpp"
#include "services/common/runtime/config/reader.hpp"

namespace boresight::config {

/// Reads the open document; a key that is absent keeps its defaults. Throws Error with all problems.
[[nodiscard]] extended_object::ObjectClassTable read_object_classes(Reader root);

}  // namespace boresight::config
