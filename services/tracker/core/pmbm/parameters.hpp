// Numbers of the PMBM filter that are neither motion nor sensor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::tracking::pmbm {

struct Parameters {
  double gate_chi2 = 13.816;     ///< squared distance of a measurement to an object: 0.999 of two degrees of freedom
  double cell_gate_chi2 = 20.7;  ///< the same for one of a cell: 0.99997 (choice: 14 … 21 are alike)
  double prune_weight = 1e-3;    ///< a global hypothesis below this share of its group is dropped
  double candidate_log = 7.0;    ///< associations less likely than the best by e^−this are no hypotheses
  double search_log = 10.0;      ///< nor searched from, before measurements are shared (choice: 7 is worse, 14 alike)
  double merge_distance = 1.0;   ///< hypotheses of one object nearer than this are one (component.hpp; choice: time)
  double birth_merge_distance = 2.0;        ///< the same of an undetected object and a birth (choice)
  double min_existence = 0.1;               ///< below it an object goes back to the Poisson part
  double min_poisson_weight = 1e-3;         ///< below it a component of the Poisson part is dropped
  double join_existence = 0.5;              ///< objects above it may be parts of one
  double min_detection_probability = 1e-3;  ///< of an object: below it nothing of the scan is its own (choice: time)
  double min_share = 1e-3;                  ///< of a measurement: a cell with less of it has none (choice: time)
  int sharing_passes = 3;                   ///< of soft sharing, the first among hard cells (choice: 2 is worse)
  double first_cell_links = 0.7;   ///< link distance of the first cells of new objects, relative (choice: 1 is worse)
  double report_existence = 0.05;  ///< objects below it are not reported
  std::uint32_t work_budget = 12000;  ///< likelihood evaluations of a scan; beyond it nothing is searched or shared
};

/// Largest numbers, reserved at the start.
struct Capacity {
  std::size_t measurements = 1024;      ///< of a scan
  std::size_t objects = 384;            ///< tracked, tentative ones included
  std::size_t local_hypotheses = 8192;  ///< of all objects
  std::size_t groups = 512;
  std::size_t group_objects = 128;  ///< a group grows no further: its gates are cut there
  std::size_t group_measurements = 256;
  std::size_t rows = 16;        ///< global hypotheses of a group
  std::size_t candidates = 48;  ///< associations of a group that become hypotheses; twice as many are collected
  std::size_t poisson_components = 64;
  std::size_t remembered_cells = 8192;    ///< likelihoods of cells of a group; a power of two
  std::size_t known_associations = 1024;  ///< of a group
};

}  // namespace boresight::tracking::pmbm
