#include "services/ghost_filter/core/evidence_filter.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/ghost_filter/core/published/filter.hpp"

namespace boresight::ghosts {

std::unique_ptr<Method> make_method(const Config& config) {
  if (config.method == MethodName::kEvidence) return std::make_unique<EvidenceFilter>(config.evidence);
  return std::make_unique<published::Filter>(config.published);
}

}  // namespace boresight::ghosts
