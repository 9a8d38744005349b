// Names of the messages' enumeration values, the same in plots, logs, records and diagnostics.
#pragma once

#include <string>
#include <string_view>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"

namespace boresight {

namespace detail {
/// The name of a value; "?" for an unknown value, as after an update of one process only.
template <typename Enum, std::size_t N>
[[nodiscard]] constexpr std::string_view word_of(const std::array<std::string_view, N>& words, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? words[index] : "?";
}
}  // namespace detail

[[nodiscard]] constexpr std::string_view name_of(AlignmentState state) {
  constexpr std::array<std::string_view, 4> kNames = {"no data", "waiting", "converging", "converged"};
  return detail::word_of(kNames, state);
}
[[nodiscard]] constexpr std::string_view name_of(DataQualifier qualifier) {
  constexpr std::array<std::string_view, 3> kNames = {"AVAILABLE", "AVAILABLE_REDUCED", "NOT_AVAILABLE"};
  return detail::word_of(kNames, qualifier);
}
[[nodiscard]] constexpr std::string_view name_of(ExtendedQualifier qualifier) {
  constexpr std::array<std::string_view, 11> kNames = {"NORMAL",
                                                       "MISALIGNED",
                                                       "NO_DATA",
                                                       "RATE_REDUCED",
                                                       "INVALID_DATA",
                                                       "BLOCKED",
                                                       "BEGINNING_BLOCKAGE",
                                                       "EXTERNAL_DISTURBANCE",
                                                       "INITIALISING",
                                                       "WRONG_INPUT",
                                                       "DELAYED"};
  return detail::word_of(kNames, qualifier);
}
[[nodiscard]] constexpr std::string_view name_of(AxisEffect effect) {
  constexpr std::array<std::string_view, 4> kNames = {"unknown", "compensated", "reduced", "not available"};
  return detail::word_of(kNames, effect);
}
/// The names of source_condition bits, as in "partly blocked, supply"; empty without bits.
[[nodiscard]] inline std::string words_of_conditions(std::uint32_t bits) {
  constexpr std::array<std::string_view, 7> kNames = {"blocked",     "partly blocked", "defective",         "supply",
                                                      "temperature", "unsynchronised", "without ego motion"};
  std::string words;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if ((bits >> i & 1u) == 0) continue;
    if (!words.empty()) words += ", ";
    words += kNames[i];
  }
  return words;
}
[[nodiscard]] constexpr std::string_view name_of(ServiceCondition condition) {
  constexpr std::array<std::string_view, 5> kNames = {"unknown", "alive", "degraded", "silent", "restarted"};
  return detail::word_of(kNames, condition);
}
[[nodiscard]] constexpr std::string_view name_of(MovementState movement) {
  constexpr std::array<std::string_view, 4> kNames = {"unknown", "moving", "stationary", "stopped"};
  return detail::word_of(kNames, movement);
}
[[nodiscard]] constexpr std::string_view name_of(Provenance provenance) {
  constexpr std::array<std::string_view, kNumberOfProvenances> kNames = {"unknown", "moving",  "stationary", "type 1",
                                                                         "type 2",  "clutter", "ambiguity"};
  return detail::word_of(kNames, provenance);
}
[[nodiscard]] constexpr std::string_view name_of(ObjectClass object_class) {
  constexpr std::array<std::string_view, kNumberOfObjectClasses> kNames = {"unknown",     "car",        "truck",
                                                                           "two_wheeler", "pedestrian", "van"};
  return detail::word_of(kNames, object_class);
}
[[nodiscard]] constexpr std::string_view name_of(Fault fault) {
  constexpr std::array<std::string_view, kNumberOfFaults> kNames = {"input lost",
                                                                    "memory pool exhausted",
                                                                    "wrong length",
                                                                    "wrong value",
                                                                    "unknown message",
                                                                    "recording syntax",
                                                                    "side input missing",
                                                                    "time jump",
                                                                    "wrong version",
                                                                    "over capacity",
                                                                    "link",
                                                                    "input dropped",
                                                                    "work budget",
                                                                    "foreign memory"};
  return detail::word_of(kNames, fault);
}

}  // namespace boresight
