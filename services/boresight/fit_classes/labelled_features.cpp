#include "services/boresight/fit_classes/labelled_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "services/simulator/drive.hpp"
#include "services/tracker/core/classes/track_evidence.hpp"

namespace boresight::fit_classes {

using extended_object::RoadUserClass;

namespace {

constexpr double kBetweenRows_s = 0.5;
constexpr double kLeastExistence = 0.5;  // of tracks that count
constexpr double kMostDistance_m = 2.0;  // of a track's centre from the box of its object
constexpr std::array<std::string_view, extended_object::kRoadUserClasses> kClassNames = {"pedestrian", "two_wheeler",
                                                                                         "car", "van", "truck"};

[[nodiscard]] RoadUserClass class_of(simulator::BodyKind kind) {
  switch (kind) {
    case simulator::BodyKind::kPedestrian:
      return RoadUserClass::kPedestrian;
    case simulator::BodyKind::kCyclist:
      return RoadUserClass::kTwoWheeler;
    case simulator::BodyKind::kVan:
      return RoadUserClass::kVan;
    case simulator::BodyKind::kTruck:
      return RoadUserClass::kTruck;
    case simulator::BodyKind::kCar:
      break;
  }
  return RoadUserClass::kCar;
}

/// Of a body in world axes.
[[nodiscard]] double distance_m(const simulator::Body& body, const Eigen::Vector2d& point_m) {
  const double c = std::cos(body.heading_rad), s = std::sin(body.heading_rad);
  const Eigen::Vector2d d = point_m - body.position_m;
  const Eigen::Vector2d beyond(std::abs(c * d.x() + s * d.y()) - 0.5 * body.length_m,
                               std::abs(-s * d.x() + c * d.y()) - 0.5 * body.width_m);
  return beyond.cwiseMax(0.0).norm();
}

class Collector {
 public:
  Collector(const simulator::Drive& drive, const VehicleConfig& vehicle, const tracking::ObjectForest& forest)
      : drive_(drive), evidence_(vehicle, forest) {}

  void add(double t_s, const ClassifiedScan& scan, const TrackList& list) {
    evidence_.step(scan, list);
    std::erase_if(next_row_s_, [this](const auto& known) { return evidence_.find(known.first) == nullptr; });
    note_rows(t_s, list);
  }

  [[nodiscard]] std::vector<LabelledFeatures> finish() { return std::move(rows_); }

 private:
  void note_rows(double t_s, const TrackList& list) {
    const simulator::EgoState ego = drive_.ego(t_s);
    Eigen::Matrix2d to_world;
    to_world << std::cos(ego.heading_rad), -std::sin(ego.heading_rad), std::sin(ego.heading_rad),
        std::cos(ego.heading_rad);
    for (std::size_t b = 0; b < drive_.world().number_of_bodies(); ++b) {
      const simulator::Body body = drive_.world().body(b, t_s);
      if (body.parked) continue;
      const Track* nearest = nullptr;
      double nearest_m = kMostDistance_m;
      for (std::size_t k = 0; k < list.number_of_tracks; ++k) {
        const Track& track = list.tracks[k];
        if (!(static_cast<double>(track.existence_probability) >= kLeastExistence)) continue;
        const Eigen::Vector2d at(static_cast<double>(track.position_vehicle_m[0]),
                                 static_cast<double>(track.position_vehicle_m[1]));
        // Within the box, the nearer to its centre.
        const Eigen::Vector2d in_world = ego.position_m + to_world * at;
        constexpr double kTie = 1e-3;
        const double d = distance_m(body, in_world) + kTie * (in_world - body.position_m).norm();
        if (!(d < nearest_m)) continue;
        nearest_m = d;
        nearest = &track;
      }
      if (nearest == nullptr) continue;
      const tracking::ClassEvidence* const evidence = evidence_.find(nearest->tracking_id);
      if (evidence == nullptr) continue;
      const auto age_s = static_cast<double>(nearest->age_s);
      double& next_row_s = next_row_s_[nearest->tracking_id];
      if (age_s < next_row_s) continue;
      next_row_s = age_s + kBetweenRows_s;
      rows_.push_back(
          {nearest->tracking_id, body.id, class_of(body.kind), age_s, evidence->detections(), evidence->features()});
    }
  }

  const simulator::Drive& drive_;
  tracking::TrackEvidence evidence_;
  std::map<std::uint32_t, double> next_row_s_;  // by track
  std::vector<LabelledFeatures> rows_;
};

}  // namespace

std::vector<LabelledFeatures> labelled_features(const SimulatedDrive& of, const VehicleConfig& vehicle,
                                                const run::Settings& settings, const tracking::ObjectForest& forest,
                                                const std::function<void()>& look) {
  simulator::Drive drive(of.scenario, vehicle, of.seed, of.duration_s);
  run::Chain chain(vehicle, settings);
  Collector collector(drive, vehicle, forest);
  const auto scan = std::make_unique<RadarScan>();
  while (const simulator::Event* event = drive.next()) {
    chain.advance(event->stamp_ns);
    if (event->scan == nullptr) {
      EgoMotion motion = simulator::to_message(*event, vehicle.ego);
      chain.add_ego(motion, event->stamp_ns);
      continue;
    }
    *scan = *event->scan;
    if (chain.add_scan(*scan, event->stamp_ns)) collector.add(event->t_s, chain.classified(), chain.tracks());
    look();
  }
  return collector.finish();
}

std::string features_head(const tracking::ObjectForest& forest) {
  std::string text;
  for (const tracking::ForestNumber& number : tracking::forest_numbers()) {
    text += fmt::format("# {}={}\n", number.key, number.of(forest));
  }
  text += "profile,scenario,seed,track,object,class,age_s,detections";
  for (std::size_t k = 0; k < tracking::kClassFeatures; ++k) {
    text += fmt::format(",{}", tracking::name_of(static_cast<tracking::ClassFeature>(k)));
  }
  return text + "\n";
}

std::string features_row(const std::string& profile, const std::string& scenario, std::uint64_t seed,
                         const LabelledFeatures& row) {
  std::string text = fmt::format("{},{},{},{},{},{},{:.2f},{:.2f}", profile, scenario, seed, row.track, row.object,
                                 kClassNames[static_cast<std::size_t>(row.object_class)], row.age_s, row.detections);
  for (const double value : row.features) {
    text += std::isfinite(value) ? fmt::format(",{:.5g}", value) : std::string(",");
  }
  return text + "\n";
}

}  // namespace boresight::fit_classes
