// Numbers of the PHD filter that are neither motion nor sensor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::tracking::phd {

struct Parameters {
  double gate_chi2 = 13.816;    ///< squared distance of a measurement to an object: 0.999 of two degrees of freedom
  double prune_weight = 0.03;   ///< lighter components are dropped (choice: 0.001 … 0.03 differ in work)
  double merge_distance = 4.0;  ///< nearer components are one (ggiw/component.hpp, distance; choice: 2 … 6 are alike)
  double min_poisson_weight = 1e-3;         ///< lighter components of the intensity of births are dropped
  double min_detection_probability = 1e-3;  ///< of an object: below it nothing of the scan is its own (choice: time)
  double min_share = 1e-3;                  ///< of a measurement: an object has no less of it (choice: time)
  double least_entropy = 0.1;         ///< of sharing: below it the partition of the prediction does (choice: time)
  double least_cell = 0.5;            ///< measurements of a shared cell: fewer are no detection (choice)
  double object_probability = 0.5;    ///< an identity that exists as surely counts as an object in the prediction
  bool as_published = false;          ///< a component may be any number of objects: (2) instead of (6) and (7)
  double report_existence = 0.05;     ///< objects below it are not reported
  std::uint32_t work_budget = 16000;  ///< likelihood evaluations of a scan; beyond it no further partition is weighed
};

/// Largest numbers, reserved at the start.
struct Capacity {
  std::size_t measurements = 1024;    ///< of a scan
  std::size_t components = 768;       ///< of the intensity, births apart
  std::size_t group_components = 64;  ///< a group grows no further: its gates are cut there
  std::size_t group_measurements = 256;
  std::size_t group_children = 512;  ///< corrected components of a group before they are merged
  std::size_t partitions = 32;       ///< of a block
  std::size_t cells = 512;           ///< different cells of a block
  std::size_t poisson_components = 64;
};

}  // namespace boresight::tracking::phd
