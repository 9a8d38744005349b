// Trouble codes of the pipeline.
#include "services/boresight/monitor/snapshot.hpp"
#include "services/health/core/faults/event.hpp"

namespace boresight::monitor {

std::vector<FailedEvent> failed_events_of(const PipelineSnapshot& pipeline) {
  std::vector<FailedEvent> failed;
  for (std::size_t i = 0; i < kNumberOfPipelineEvents; ++i) {
    if ((pipeline.failed_events >> i & 1U) == 0) continue;
    const health::EventKind kind = health::kind_of(static_cast<PipelineEvent>(i));
    failed.push_back({health::code_text(health::dtc_of({kind})), health::type_of(kind).meaning});
  }
  return failed;
}

}  // namespace boresight::monitor
