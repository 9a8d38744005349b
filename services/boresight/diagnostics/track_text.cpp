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

std::string_view side_word(const perception::RoadEdge& edge) {
  return edge.side() == perception::LEFT_SIDE ? "left" : "right";
}

std::string edge_line(const perception::RoadEdge& e) {
  const auto number = [](float value, int decimals) { return text::fixed(value, decimals); };
  return fmt::format("  road edge {} {}: y {} m, slope {}, curvature {} /m, from x {} to {} m, existence {}",
                     e.edge_id(), side_word(e), number(e.coefficients()[0], 2), number(e.coefficients()[1], 3),
                     number(e.coefficients()[2], 4), number(e.start_x_m(), 0), number(e.end_x_m(), 0),
                     number(e.existence_probability(), 2));
}

std::string object_line(const perception::PathObject& o) {
  const auto number = [](float value, int decimals) { return text::fixed(value, decimals); };
  return fmt::format("  {} {} {}: x {} m, y {} m, in {} ± {} s, probability {}",
                     o.warning() != 0 ? "collision warning:" : "on the path:",
                     o.kind() == perception::TRACKED_OBJECT ? "track" : "obstacle", o.object_id(),
                     number(o.position_vehicle_m()[0], 1), number(o.position_vehicle_m()[1], 1),
                     number(o.time_to_collision_s(), 1), number(o.time_to_collision_std_s(), 1),
                     number(o.collision_probability(), 2));
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

json::Value edge_object(const perception::RoadEdge& e) {
  json::Value object;
  object["id"] = e.edge_id();
  object["side"] = side_word(e);
  object["update"] = e.update() == perception::MEASURED ? "measured" : "predicted";
  object["age_s"] = json::shortest(e.age_s());
  object["time_since_update_s"] = json::shortest(e.time_since_update_s());
  object["existence_probability"] = json::shortest(e.existence_probability());
  object["start_x_m"] = json::shortest(e.start_x_m());
  object["end_x_m"] = json::shortest(e.end_x_m());
  object["scatter_std_m"] = json::shortest(e.scatter_std_m());
  object["coefficients"] = numbers_of(e.coefficients());
  object["covariance"] = numbers_of(e.covariance());
  object["detections"] = e.number_of_detections();
  return object;
}

json::Value path_object(const perception::PathObject& o) {
  json::Value object;
  object["id"] = o.object_id();
  object["kind"] = o.kind() == perception::TRACKED_OBJECT ? "track" : "obstacle";
  object["update"] = o.update() == perception::MEASURED ? "measured" : "predicted";
  object["warning"] = o.warning() != 0;
  object["age_s"] = json::shortest(o.age_s());
  object["existence_probability"] = json::shortest(o.existence_probability());
  object["collision_probability"] = json::shortest(o.collision_probability());
  object["time_to_collision_s"] = json::shortest(o.time_to_collision_s());
  object["time_to_collision_std_s"] = json::shortest(o.time_to_collision_std_s());
  object["required_deceleration_mps2"] = json::shortest(o.required_deceleration_mps2());
  object["path_offset_m"] = json::shortest(o.path_offset_m());
  object["path_offset_std_m"] = json::shortest(o.path_offset_std_m());
  object["length_m"] = json::shortest(o.length_m());
  object["width_m"] = json::shortest(o.width_m());
  object["position_vehicle_m"] = numbers_of(o.position_vehicle_m());
  object["velocity_over_ground_mps"] = numbers_of(o.velocity_over_ground_mps());
  object["position_covariance_m2"] = numbers_of(o.position_covariance_m2());
  return object;
}

}  // namespace

std::string to_lines(const perception::TrackList& list) {
  std::string lines = fmt::format("{} {}: {} tracks, {} confirmed, after a scan of radar {}",
                                  shown_time(list.time_ns()), text::printable(list.vehicle_name()),
                                  list.tracks().size(), list.number_of_confirmed_tracks(), list.radar_id());
  for (const perception::Track& track : list.tracks()) lines += "\n" + track_line(track);
  for (const perception::RoadEdge& edge : list.road_edges()) lines += "\n" + edge_line(edge);
  for (const perception::PathObject& object : list.path_objects()) lines += "\n" + object_line(object);
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
  json::Value& edges = object["road_edges"] = json::Value::array();
  for (const perception::RoadEdge& edge : list.road_edges()) edges.push_back(edge_object(edge));
  object["collision_warnings"] = list.number_of_collision_warnings();
  object["dropped_path_objects"] = list.dropped_path_objects();
  json::Value& objects = object["path_objects"] = json::Value::array();
  for (const perception::PathObject& o : list.path_objects()) objects.push_back(path_object(o));
  return json::line(object);
}

}  // namespace boresight::diagnostics_text
