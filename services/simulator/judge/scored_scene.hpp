// What the judge of tracks compares at one time: the true objects and the tracks, both in the vehicle frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::judge {

struct TrueObject {
  Object box;
  ObjectClass object_class = ObjectClass::kUnknown;
  bool parked = false;  ///< stands still: no tracker of moving objects is asked for it
  bool in_view = true;  ///< a radar can see it; objects out of view are neither demanded nor forbidden
};

struct ScoredTrack {
  std::uint32_t id = 0;
  bool confirmed = false;
  MovementState movement = MovementState::kUnknown;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();  ///< over ground, in vehicle axes
  double heading_rad = 0.0, length_m = 0.0, width_m = 0.0;
  Eigen::Matrix2d position_covariance_m2 = Eigen::Matrix2d::Zero();

  [[nodiscard]] bool says_it_stands() const {
    return movement == MovementState::kStationary || movement == MovementState::kStopped;
  }
};

/// Range bands, by the distance of the centre from the vehicle's origin. Choice: near, middle, and the reach of the
/// radars of docs/radar-statistics (100 m); beyond the last edge nothing is judged.
inline constexpr std::array<double, 4> kBandEdges_m = {0.0, 30.0, 60.0, 100.0};
inline constexpr std::size_t kBands = kBandEdges_m.size() - 1;
inline constexpr std::array<std::string_view, kBands + 1> kBandNames = {"0_30m", "30_60m", "60_100m", "all_ranges"};
inline constexpr std::size_t kAllBands = kBands;  ///< index of "all_ranges"

/// Index of the band; nothing beyond the last edge.
[[nodiscard]] inline std::optional<std::size_t> band_of(const Eigen::Vector2d& position_m) {
  const double range_m = position_m.norm();
  for (std::size_t i = 0; i < kBands; ++i) {
    if (range_m < kBandEdges_m[i + 1]) return i;
  }
  return std::nullopt;
}

/// Classes of the figures, by ObjectClass: vans count as cars, as in class_of_word().
inline constexpr std::size_t kClasses = 5;
inline constexpr std::array<std::string_view, kClasses> kClassNames = {"unknown", "car", "truck", "two_wheeler",
                                                                       "pedestrian"};

[[nodiscard]] constexpr std::size_t index_of(ObjectClass object_class) {
  const auto index = static_cast<std::size_t>(object_class == ObjectClass::kVan ? ObjectClass::kCar : object_class);
  return index < kClasses ? index : 0;
}

/// Class of a word of a truth table: the names above, and car: van, taxi; truck: bus, trailer, construction_vehicle;
/// two_wheeler: cyclist, bicycle, motorcycle; pedestrian: person. Other words are kUnknown.
[[nodiscard]] ObjectClass class_of_word(std::string_view word);

}  // namespace boresight::judge
