// From probabilities of road users to the classes of a track.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "interfaces/messages/track_list.hpp"
#include "services/common/extended_object/object_classes.hpp"

namespace boresight::tracking {

/// Writes class probabilities, in the order of RoadUserClass, and the likeliest class.
inline void publish_class(std::span<const double, extended_object::kRoadUserClasses> probability, Track& track) {
  constexpr std::array kPublished = {ObjectClass::kPedestrian, ObjectClass::kTwoWheeler, ObjectClass::kCar,
                                     ObjectClass::kVan, ObjectClass::kTruck};
  static_assert(kPublished.size() == extended_object::kRoadUserClasses);
  for (std::size_t k = 0; k < kPublished.size(); ++k) {
    track.class_probability[static_cast<std::size_t>(kPublished[k])] = static_cast<float>(probability[k]);
  }
  const auto likeliest = std::max_element(probability.begin(), probability.end()) - probability.begin();
  track.object_class = kPublished[static_cast<std::size_t>(likeliest)];
}

}  // namespace boresight::tracking
