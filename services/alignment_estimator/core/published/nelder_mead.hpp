// Burza 2025, (28): the simplex of Nelder and Mead on a few detections of each scan, filtered over time.
#pragma once

#include "services/alignment_estimator/core/published/published_method.hpp"

namespace boresight::alignment::published {

class NelderMead final : public PublishedMethod {
 public:
  NelderMead(const VehicleConfig& vehicle, const PublishedConfig& config)
      : PublishedMethod(vehicle, config, 4, config.nelder_mead_detections), signs_(config.seed ^ 0x9e37U) {}

 private:
  [[nodiscard]] Eigen::Vector4d step(const ScanView& scan) override;
  Draw signs_;
};

}  // namespace boresight::alignment::published
