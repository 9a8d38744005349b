// The forest of the classes as plain data: what config/services/object_forest.csv states.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "services/common/extended_object/object_classes.hpp"

namespace boresight::tracking {

/// By extended_object::RoadUserClass.
using ClassProbabilities = std::array<double, extended_object::kRoadUserClasses>;

/// A node. Nodes are in the order of a walk that takes the smaller side first: the child of values up to the threshold
/// is the next node.
struct ForestNode {
  static constexpr auto kLeaf = std::numeric_limits<std::uint16_t>::max();
  std::uint16_t feature = kLeaf;  ///< that is asked; kLeaf: none
  std::uint32_t other = 0;        ///< index of the child of values above the threshold; of a leaf: index of its row
  float threshold = 0.0F;
};

struct ForestTable {
  std::vector<float> missing;        ///< by feature: its value where it is not known
  std::vector<std::uint32_t> trees;  ///< index of the first node of each
  std::vector<ForestNode> nodes;
  std::vector<std::array<float, extended_object::kRoadUserClasses>> leaves;
  double exponent = 1.0;
  ClassProbabilities prior_share{0.2, 0.2, 0.2, 0.2, 0.2};  ///< of the classes in training
};

/// Numbers by which features are made. The forest is grown with them, so its table states them.
struct ClassEvidenceParameters {
  double memory_s = 5.0;             ///< of sums and extremes (choice: follows, or knows more)
  double count_range_m = 30.0;       ///< the expected number of detections is 1 here …
  double count_power = 0.8;          ///< … and falls by range^−power (measured: radar-statistics R)
  double near_range_m = 8.0;         ///< it grows no more within this range (choice)
  double wide_range_rate_mps = 0.5;  ///< deviation of a range rate that is not the body's (measured: R)
  double least_in_view = 0.5;        ///< scans with a smaller probability of being in view are no misses (choice)
  double course_s = 0.5;             ///< between courses that are compared: noise is no turn (choice)
  double gate_m = 1.5;               ///< a track's own detections are nearer to its box (choice: parts and noise) …
  double gate_rad = 0.01;            ///< … by so much more of the range (choice: azimuth noise)
  double gate_most_std_m = 2.0;      ///< … and by the track's own deviation up to this (choice)
  double gate_mps = 1.5;             ///< largest deviation of their range rates (choice) …
  double gate_by_speed = 0.3;        ///< … and so much more of the speed (choice: turning and swinging parts)
};

struct RadarLevelParameters {
  double memory_s = 10.0;      ///< of the level (choice)
  double prior_number = 20.0;  ///< detections that a band needs before its level counts more than that of all (choice)
  double first_band_m = 10.0;  ///< far edge of the nearest band of range (choice)
};

struct ObjectForest {
  ForestTable table;
  ClassEvidenceParameters evidence;
  RadarLevelParameters levels;
};

/// A number of the table beside the trees.
struct ForestNumber {
  std::string_view key;
  double least, most;  ///< allowed
  double& (*value_of)(ObjectForest& forest);
  [[nodiscard]] double of(ObjectForest forest) const { return value_of(forest); }
};
/// All of them, in the order of the table.
[[nodiscard]] std::span<const ForestNumber> forest_numbers();

}  // namespace boresight::tracking
