#include "services/alignment_estimator/core/make_method.hpp"

#include <stdexcept>

#include "services/alignment_estimator/core/planar/planar_filter.hpp"
#include "services/alignment_estimator/core/published/published.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"

namespace boresight::alignment {

std::unique_ptr<Method> make_method(const VehicleConfig& vehicle, const Config& config) {
  using published::Kind;
  const auto make = [&](Kind kind) { return published::make_published(kind, vehicle, config.published); };
  switch (config.method) {
    case MethodName::kBoresight:
      return std::make_unique<WindowedFilter>(vehicle, config.filter, config.windows);
    case MethodName::kSteepestDescent:
      return make(Kind::kSteepestDescent);
    case MethodName::kNls:
      return make(Kind::kLeastSquares);
    case MethodName::kTls:
      return make(Kind::kTotalLeastSquares);
    case MethodName::kNelderMead:
      return make(Kind::kNelderMead);
    case MethodName::kAzimuth1d:
      return make(Kind::kAzimuth1d);
    case MethodName::kBoresightPlanar: {
      planar::PlanarConfig planar;
      planar.min_speed_mps = config.min_speed_mps();
      planar.prior_angle_std_rad = config.prior_angle_std_rad();
      return std::make_unique<planar::PlanarFilter>(vehicle, planar);
    }
  }
  throw std::invalid_argument("unknown alignment method");
}

}  // namespace boresight::alignment
