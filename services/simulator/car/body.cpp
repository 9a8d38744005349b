#include "services/simulator/car/body.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/random.hpp"

namespace boresight::simulator::car {

SideSlip::SideSlip(const RealCar& car, std::uint64_t seed, double duration_s) {
  if (car.side_slip_std_rad == 0.0) return;
  constexpr double kKnotsPerCorrelation = 10.0;
  step_s_ = car.side_slip_correlation_s / kKnotsPerCorrelation;
  const double decay = std::exp(-1.0 / kKnotsPerCorrelation);
  const double kick_rad = car.side_slip_std_rad * std::sqrt(1.0 - decay * decay);
  Stream stream(seed, "real car side slip");
  double slip_rad = car.side_slip_std_rad * stream.gaussian();
  const auto steps = static_cast<std::size_t>(std::max(0.0, duration_s) / step_s_) + 2;
  for (std::size_t i = 0; i <= steps; ++i) {
    knots_rad_.push_back(slip_rad);
    slip_rad = decay * slip_rad + kick_rad * stream.gaussian();
  }
}

double SideSlip::at(double t_s) const {
  if (knots_rad_.empty()) return 0.0;
  const double at = std::clamp(t_s / step_s_, 0.0, static_cast<double>(knots_rad_.size() - 1));
  const std::size_t before = std::min(static_cast<std::size_t>(at), knots_rad_.size() - 2);
  const double share = at - static_cast<double>(before);
  return knots_rad_[before] + share * share * (3.0 - 2.0 * share) * (knots_rad_[before + 1] - knots_rad_[before]);
}

}  // namespace boresight::simulator::car
