// Numbers of the PMBM filter that are neither motion nor sensor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::tracking::pmbm {

struct Parameters {
  double gate_chi2 = 13.816;    ///< squared distance of a measurement to an object: 0.999 of two degrees of freedom
  double prune_weight = 1e-3;   ///< a global hypothesis below this share of its group is dropped
  double candidate_log = 7.0;   ///< associations less likely than the best by e^−this are no hypotheses
  double merge_distance = 1.0;  ///< local hypotheses nearer than this are one (component.hpp, distance)
  double min_existence = 0.1;   ///< below it an object goes back to the Poisson part
  double min_poisson_weight = 1e-3;   ///< below it a component of the Poisson part is dropped
  double report_existence = 0.05;     ///< objects below it are not reported
  std::uint32_t work_budget = 16000;  ///< likelihood evaluations of a scan; beyond it nothing is searched or shared
};

/// Largest numbers, reserved at the start.
struct Capacity {
  std::size_t measurements = 1024;      ///< of a scan
  std::size_t objects = 384;            ///< tracked, tentative ones included
  std::size_t local_hypotheses = 4096;  ///< of all objects
  std::size_t groups = 512;
  std::size_t group_objects = 64;  ///< a group grows no further: its gates are cut there
  std::size_t group_measurements = 256;
  std::size_t rows = 16;        ///< global hypotheses of a group
  std::size_t candidates = 48;  ///< associations of a group that become hypotheses
  std::size_t poisson_components = 64;
};

}  // namespace boresight::tracking::pmbm
