#include "services/common/runtime/version.hpp"

namespace boresight::runtime {

std::string_view software_version() {
  return BORESIGHT_VERSION;
}

}  // namespace boresight::runtime
