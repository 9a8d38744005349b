// Enumerations of messages as those of the IDL, which have the same order.
#pragma once

namespace boresight::dds {

/// The IDL's enumerator with the same value. A value beyond `last` becomes the first one: a sample with an impossible
/// value would be refused by its readers.
template <typename Target, typename Source>
[[nodiscard]] constexpr Target enumerator(Source value, Target last) {
  return static_cast<int>(value) <= static_cast<int>(last) ? static_cast<Target>(value) : Target{};
}

}  // namespace boresight::dds
