#include "services/alignment_estimator/core/make_method.hpp"

#include <stdexcept>

#include "services/alignment_estimator/core/azimuth_1d_method.hpp"

namespace boresight::alignment {

std::unique_ptr<Method> make_method(const VehicleConfig& vehicle, const Config& config) {
  if (config.method == MethodName::kAzimuth1d) return std::make_unique<Azimuth1dMethod>(vehicle, config);
  throw std::invalid_argument("this alignment method is not on offer");
}

}  // namespace boresight::alignment
