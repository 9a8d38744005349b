#include "services/simulator/judge/scored_scene.hpp"

#include <algorithm>
#include <utility>

namespace boresight::judge {

ObjectClass class_of_word(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, ObjectClass>, 14> kClassWords = {{
      {"car", ObjectClass::kCar},
      {"van", ObjectClass::kCar},
      {"taxi", ObjectClass::kCar},
      {"truck", ObjectClass::kTruck},
      {"bus", ObjectClass::kTruck},
      {"trailer", ObjectClass::kTruck},
      {"construction_vehicle", ObjectClass::kTruck},
      {"two_wheeler", ObjectClass::kTwoWheeler},
      {"cyclist", ObjectClass::kTwoWheeler},
      {"bicycle", ObjectClass::kTwoWheeler},
      {"motorcycle", ObjectClass::kTwoWheeler},
      {"pedestrian", ObjectClass::kPedestrian},
      {"person", ObjectClass::kPedestrian},
      {"unknown", ObjectClass::kUnknown},
  }};
  const auto* const found =
      std::find_if(kClassWords.begin(), kClassWords.end(), [word](const auto& entry) { return entry.first == word; });
  return found == kClassWords.end() ? ObjectClass::kUnknown : found->second;
}

}  // namespace boresight::judge
