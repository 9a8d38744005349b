#include "services/alignment_estimator/core/published/nelder_mead.hpp"

#include "services/alignment_estimator/core/published/simplex.hpp"

namespace boresight::alignment::published {

Eigen::Vector4d NelderMead::step(const ScanView& scan) {
  const auto cost = [&scan](const Eigen::Vector4d& b) {
    const PlanarModel model = scan.model(b);
    double sum = 0.0;
    for (const std::uint16_t i : scan.selected) {
      const double r = scan.residual(model.value(scan.detections.azimuth_rad[i], scan.detections.elevation_rad[i]), i);
      sum += r * r;
    }
    return sum;
  };
  Eigen::Vector4d edge(config().nelder_mead_edge.data());
  for (int i = 0; i < 4; ++i) {
    if ((signs_.next() & 1U) != 0) edge(i) = -edge(i);
  }
  Simplex simplex(scan.b, edge, scan.parameters, cost);
  for (int i = 0; i < config().nelder_mead_iterations; ++i) simplex.iterate(cost);
  return (simplex.best() - scan.b) / config().nelder_mead_filter_scans;
}

}  // namespace boresight::alignment::published
