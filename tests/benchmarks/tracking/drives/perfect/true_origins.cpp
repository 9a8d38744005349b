#include "tests/benchmarks/tracking/drives/perfect/true_origins.hpp"

#include <algorithm>

namespace boresight::bench::tracking {

void set_true_origins(const std::vector<score::TrueOrigin>& origins, ClassifiedScan& scan) {
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, origins.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (scan.provenance[i] != Provenance::kUnknown) scan.set_certain(i, origins[i].provenance);
  }
}

}  // namespace boresight::bench::tracking
