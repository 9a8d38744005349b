#include "services/boresight/diagnostics/track_text.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/names.hpp"
#include "services/boresight/diagnostics/sample_time.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::diagnostics_text {

namespace {

constexpr std::array<std::string_view, 5> kTimeSources = {"unknown", "sensor_synchronised", "sensor_free_running",
                                                          "link_arrival", "user_arrival"};
constexpr std::array<std::string_view, kNumberOfStages> kStageNames = {"ingest_gateway", "detection_corrector",
                                                                       "ghost_filter", "tracker"};

std::string_view class_word(perception::ObjectClass object_class) {
  return name_of(static_cast<ObjectClass>(object_class));
}
std::string_view movement_word(perception::MovementState movement) {
  return name_of(static_cast<MovementState>(movement));
}
std::string_view status_word(const perception::Track& track) {
  return track.status() == perception::CONFIRMED ? "confirmed" : "tentative";
}
std::string_view update_word(const perception::Track& track) {
  return track.update() == perception::MEASURED ? "measured" : "predicted";
}

std::string track_line(const perception::Track& t) {
  const auto number = [](float value, int decimals) { return text::fixed(value, decimals); };
  return fmt::format(
      "  {:>8} {:<9} {:<9} {:<10} {:<11} x {:>7} m  y {:>7} m  v_x {:>6} m/s  v_y {:>6} m/s  {} × {} m  heading {:>4}° "
      " "
      "existence {}",
      t.tracking_id(), status_word(t), update_word(t), movement_word(t.movement()), class_word(t.object_class()),
      number(t.position_vehicle_m()[0], 2), number(t.position_vehicle_m()[1], 2),
      number(t.velocity_over_ground_mps()[0], 2), number(t.velocity_over_ground_mps()[1], 2), number(t.length_m(), 1),
      number(t.width_m(), 1), text::fixed(t.heading_rad() * kDegreesPerRadian, 0),
      number(t.existence_probability(), 2));
}

template <typename Numbers>
json::Value numbers_of(const Numbers& values) {
  json::Value array = json::Value::array();
  for (const float value : values) array.push_back(json::shortest(value));
  return array;
}

json::Value track_object(const perception::Track& t) {
  json::Value object;
  object["id"] = t.tracking_id();
  object["status"] = status_word(t);
  object["update"] = update_word(t);
  object["movement"] = movement_word(t.movement());
  object["class"] = class_word(t.object_class());
  object["age_s"] = json::shortest(t.age_s());
  object["time_since_update_s"] = json::shortest(t.time_since_update_s());
  object["existence_probability"] = json::shortest(t.existence_probability());
  object["mirror_probability"] = json::shortest(t.mirror_probability());
  object["heading_rad"] = json::shortest(t.heading_rad());
  object["length_m"] = json::shortest(t.length_m());
  object["width_m"] = json::shortest(t.width_m());
  object["height_m"] = json::shortest(t.height_m());
  object["position_vehicle_m"] = numbers_of(t.position_vehicle_m());
  object["velocity_over_ground_mps"] = numbers_of(t.velocity_over_ground_mps());
  object["detections"] = t.number_of_detections();
  object["flags"] = t.flags();
  json::Value& probabilities = object["class_probability"];
  for (std::size_t i = 0; i < kNumberOfObjectClasses; ++i) {
    probabilities[std::string(name_of(static_cast<ObjectClass>(i)))] = json::shortest(t.class_probability()[i]);
  }
  object["covariance"] = numbers_of(t.covariance());
  return object;
}

}  // namespace

std::string to_lines(const perception::TrackList& list) {
  std::string lines = fmt::format("{} {}: {} tracks, {} confirmed, after a scan of radar {}",
                                  shown_time(list.time_ns()), text::printable(list.vehicle_name()),
                                  list.tracks().size(), list.number_of_confirmed_tracks(), list.radar_id());
  for (const perception::Track& track : list.tracks()) lines += "\n" + track_line(track);
  return lines;
}

std::string to_json(const perception::TrackList& list) {
  json::Value object;
  object["vehicle"] = list.vehicle_name();
  object["time_ns"] = list.time_ns();
  object["measurement_time_ns"] = list.measurement_time_ns();
  const auto source = static_cast<std::size_t>(list.time_source());
  object["time_source"] = source < kTimeSources.size() ? kTimeSources[source] : "?";
  object["layout_version"] = list.layout_version();
  object["radar_id"] = list.radar_id();
  object["sequence_number"] = list.sequence_number();
  object["scan_sequence_number"] = list.scan_sequence_number();
  for (std::size_t i = 0; i < kNumberOfStages; ++i) {
    json::Value& stage = object["stages"][std::string(kStageNames[i])];
    stage["begin_ns"] = list.stages()[i].begin_ns();
    stage["end_ns"] = list.stages()[i].end_ns();
  }
  object["confirmed_tracks"] = list.number_of_confirmed_tracks();
  object["flags"] = list.flags();
  object["dropped_tracks"] = list.dropped_tracks();
  object["tracker_flags"] = list.tracker_flags();
  object["likelihood_evaluations"] = list.likelihood_evaluations();
  json::Value& tracks = object["tracks"] = json::Value::array();
  for (const perception::Track& track : list.tracks()) tracks.push_back(track_object(track));
  return json::line(object);
}

}  // namespace boresight::diagnostics_text
