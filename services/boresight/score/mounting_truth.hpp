// The true mounting of each radar and the true speed scale at any time of a simulated drive.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "services/boresight/score/car_truth.hpp"
#include "services/boresight/score/table.hpp"
#include "services/boresight/score/truth_source.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/judge/alignment_judge.hpp"

namespace boresight::score {

/// Actual − nominal angles of a radar about its own axes.
struct TrueAngles {
  double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
  std::uint32_t step_changes = 0;
};

class MountingTruthReader {
 public:
  /// Reads truth_sensors.csv as the time goes on, or else the constant angles of truth.csv.
  MountingTruthReader(const TruthSource& truth, const VehicleConfig& vehicle);

  /// The latest truth of a radar up to a time, as an estimator in the car can know it: the rotation includes the
  /// load at the start of the drive, which no data tell from a mounting error, and the speed scale includes the radar's
  /// own scale of range rates. A load that changes later is a state of its own.
  /// Nothing is known of radars that are not in the vehicle file.
  [[nodiscard]] judge::MountingTruth at(std::uint32_t radar, double t_s);
  /// Whether an angle about the radar's own axes or the vehicle's axes is beyond its tolerance in the vehicle file, as
  /// health judges it; nothing if the truth is not known. The load is not included: no radar is misaligned by it.
  [[nodiscard]] std::optional<bool> is_misaligned(std::uint32_t radar, double t_s);

 private:
  void read_until(double t_s);
  /// Actual × nominalᵀ without load; nothing if it is not known.
  [[nodiscard]] std::optional<Eigen::Matrix3d> mounting(std::uint32_t radar, double t_s);

  const VehicleConfig& vehicle_;
  CarTruth car_;
  std::optional<Table> table_;
  bool has_row_ = false;
  DriveTruth drive_;
  std::map<std::uint32_t, TrueAngles> angles_;  // by radar
};

}  // namespace boresight::score
