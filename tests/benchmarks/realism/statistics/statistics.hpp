// All statistics of one radar profile.
#pragma once

#include <cstddef>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/statistics/azimuth_noise.hpp"
#include "tests/benchmarks/realism/statistics/births.hpp"
#include "tests/benchmarks/realism/statistics/body_places.hpp"
#include "tests/benchmarks/realism/statistics/false_mover_origins.hpp"
#include "tests/benchmarks/realism/statistics/false_movers.hpp"
#include "tests/benchmarks/realism/statistics/ghost_strength.hpp"
#include "tests/benchmarks/realism/statistics/object_counts.hpp"
#include "tests/benchmarks/realism/statistics/rigid_deviations.hpp"
#include "tests/benchmarks/realism/statistics/stationary_world.hpp"
#include "tests/benchmarks/realism/statistics/strength.hpp"

namespace boresight::bench::realism {

struct Statistics {
  Counting counting = Counting::kFirstToLast;  ///< that of the measured column
  std::size_t scans = 0, detections = 0;
  ObjectCounts counts;
  Births births;
  BodyPlaces places;
  RigidDeviations deviations;
  Strength strength;
  StationaryWorld stationary;
  AzimuthNoise azimuth_noise;
  FalseMovers false_movers;
  FalseMoverOrigins origins;
  GhostStrength ghosts;

  void add(const ObservedScan& scan) {
    ++scans;
    detections += scan.detections.size();
    counts.add(scan);
    births.add(scan);
    places.add(scan);
    deviations.add(scan);
    strength.add(scan);
    stationary.add(scan);
    azimuth_noise.add(scan);
    false_movers.add(scan);
    origins.add(scan);
    ghosts.add(scan);
  }
  /// Call before the scans of another drive.
  void end_drive() {
    counts.end_drive();
    births.end_drive();
    places.end_drive();
    strength.end_drive();
    stationary.end_drive();
    azimuth_noise.end_drive();
    false_movers.end_drive();
  }
  void merge(const Statistics& other) {
    scans += other.scans;
    detections += other.detections;
    counts.merge(other.counts);
    births.merge(other.births);
    places.merge(other.places);
    deviations.merge(other.deviations);
    strength.merge(other.strength);
    stationary.merge(other.stationary);
    azimuth_noise.merge(other.azimuth_noise);
    false_movers.merge(other.false_movers);
    origins.merge(other.origins);
    ghosts.merge(other.ghosts);
  }
};

}  // namespace boresight::bench::realism
