// The truth of a drive as CSV tables beside its recordings. Columns: services/simulator/README.md.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/sight.hpp"
#include "services/simulator/text_file.hpp"

namespace boresight::simulator {

class TruthTables {
 public:
  /// Throws std::runtime_error if a file cannot be written; `folder` must exist.
  TruthTables(const std::filesystem::path& folder, const Scenario& scenario, const VehicleConfig& vehicle,
              std::uint64_t seed);

  /// Adds every body within 150 m of the ego vehicle at that time.
  void add_objects(const Drive& drive, double t_s);
  /// Adds the scan that `drive` has just returned: its detections, its radar's state, the visibility of bodies.
  void add_scan(const Drive& drive, const Event& event);
  /// Writes truth.csv. Throws std::runtime_error if any write failed.
  void finish();

 private:
  struct Radar {
    const RadarConfig* config;
    car::RadarOfCar of_car;
    Sight sight;
    std::size_t scans = 0;
  };
  void add_detections(const Event& event);
  void add_sensor(const Event& event, const RadarConfig& radar);
  void add_visibility(const Drive& drive, const Event& event, Radar& radar);

  RadarEffects effects_;
  std::uint64_t seed_;
  std::vector<Radar> radars_;
  std::filesystem::path folder_;
  TextFile detections_, objects_, sensors_, visibility_;
  std::vector<BodySight> sights_;
};

}  // namespace boresight::simulator
