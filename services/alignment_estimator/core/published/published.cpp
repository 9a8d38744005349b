#include "services/alignment_estimator/core/published/published.hpp"

#include "services/alignment_estimator/core/published/least_squares.hpp"
#include "services/alignment_estimator/core/published/nelder_mead.hpp"
#include "services/alignment_estimator/core/published/steepest_descent.hpp"
#include "services/alignment_estimator/core/published/total_least_squares.hpp"

namespace boresight::alignment::published {

std::unique_ptr<Method> make_published(Kind kind, const VehicleConfig& vehicle, const PublishedConfig& config) {
  switch (kind) {
    case Kind::kSteepestDescent:
      return std::make_unique<SteepestDescent>(vehicle, config);
    case Kind::kLeastSquares:
      return std::make_unique<LeastSquares>(vehicle, config, false);
    case Kind::kTotalLeastSquares:
      return std::make_unique<TotalLeastSquares>(vehicle, config);
    case Kind::kNelderMead:
      return std::make_unique<NelderMead>(vehicle, config);
    case Kind::kAzimuth1d:
      return std::make_unique<LeastSquares>(vehicle, config, true);
  }
  return nullptr;
}

}  // namespace boresight::alignment::published
