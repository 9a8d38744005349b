#include "services/boresight/align/stds.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::align {

std::array<double, kParameters> stds_of(const alignment::VehicleForm& form) {
  std::array<double, kParameters> stds{};
  for (std::size_t i = 0; i < kParameters; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    stds.at(i) = std::sqrt(std::max(0.0, form.covariance(k, k)));
  }
  return stds;
}

}  // namespace boresight::align
