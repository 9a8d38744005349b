#include "services/ghost_filter/core/method.hpp"

#include "services/ghost_filter/core/published/filter.hpp"

namespace boresight::ghosts {

std::unique_ptr<Method> make_method(const Config& config) {
  switch (config.method) {
    case MethodName::kPublished:
      break;
  }
  return std::make_unique<published::Filter>(config.published);
}

}  // namespace boresight::ghosts
