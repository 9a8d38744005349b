#include "services/ghost_filter/core/method.hpp"

#include "services/ghost_filter/core/classify/mirror_filter.hpp"
#include "services/ghost_filter/core/published/filter.hpp"

namespace boresight::ghosts {

std::unique_ptr<Method> make_method(const Config& config) {
  if (config.method == MethodName::kMirror) return std::make_unique<MirrorFilter>(config.mirror);
  return std::make_unique<published::Filter>(config.published);
}

}  // namespace boresight::ghosts
