// The options of `boresight simulate --alignment-drive` and the drive that they specify.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/alignment/spec.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace boresight {

struct AlignmentDriveOptions {
  std::string road;  ///< "": no alignment drive
  bool planar = false;
  bool random_truth = false;
  double outlier_share = 0.25;
  double mean_detections = 60.0;
  double noise_scale = 1.0;
  bool states_stds = false;
  bool unsynchronised = false;
  double ambiguity_mps = 0.0;
  std::vector<std::uint32_t> without_elevation;  ///< radar ids
  double yaw_rate_bias_degps = 0.0;
  double slip_coefficient = 0.0;
  double body_pitch_deg = 0.0;
  double brake_pitch_deg = 0.0;
  std::vector<std::string> step_changes;
};

/// Adds the options; the returned one selects an alignment drive, and the others need it.
CLI::Option* add_alignment_drive_options(CLI::App& command, AlignmentDriveOptions& options);

/// `vehicle`: whose radars are simulated, nullptr: four corner radars. Throws std::invalid_argument for a radar that
/// the vehicle does not have and for step changes that cannot be read.
[[nodiscard]] simulator::AlignmentSpec alignment_spec(const AlignmentDriveOptions& options,
                                                      const VehicleConfig* vehicle, std::uint64_t seed,
                                                      double duration_s);

}  // namespace boresight
