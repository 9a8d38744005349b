// The truth of a real car's effects as rows of a table. Effects that are off have no row.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/car/real_car.hpp"

namespace boresight::simulator::car {

struct TruthRow {
  std::string quantity;
  std::optional<std::uint32_t> radar;  ///< id; none: of the car
  double value;
  const char* unit;
};

/// What body and ego signals do.
[[nodiscard]] std::vector<TruthRow> truth_of_car(const RealCar& car);
/// What one radar has.
[[nodiscard]] std::vector<TruthRow> truth_of_radar(const RealCar& car, const RadarOfCar& drawn, std::uint32_t radar);

}  // namespace boresight::simulator::car
