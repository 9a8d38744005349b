#include "services/boresight/score/mounting_truth.hpp"

#include <cmath>
#include <fstream>
#include <limits>

#include "interfaces/messages/header.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::score {

namespace {

constexpr double kLatestSensor_s = 4e9;

}  // namespace

MountingTruthReader::MountingTruthReader(const TruthSource& truth, const VehicleConfig& vehicle)
    : vehicle_(vehicle), car_(read_car_truth(truth.drive)) {
  if (!truth.drive.empty()) {
    std::ifstream stream(truth.drive);
    drive_ = read_drive_truth(stream);
    for (const auto& [id, radar] : drive_.radars) {
      if (!std::isfinite(radar.yaw_rad + radar.pitch_rad + radar.roll_rad)) continue;
      angles_[id] = {radar.yaw_rad, radar.pitch_rad, radar.roll_rad, 0};
    }
  }
  if (!truth.sensors.empty()) {
    table_.emplace(truth.sensors,
                   std::vector<std::string_view>{"t_s", "radar", "alignment_yaw_deg", "alignment_pitch_deg",
                                                 "alignment_roll_deg", "step_changes"});
    has_row_ = table_->next();
  }
}

void MountingTruthReader::read_until(double t_s) {
  while (has_row_ && table_->number("t_s", -kLatestSensor_s, kLatestSensor_s) <= t_s) {
    const auto angle = [&](const char* column) { return table_->number(column, -360.0, 360.0) * kRadiansPerDegree; };
    angles_[static_cast<std::uint32_t>(table_->integer("radar", 1, kMaxRadars))] = {
        angle("alignment_yaw_deg"), angle("alignment_pitch_deg"), angle("alignment_roll_deg"),
        static_cast<std::uint32_t>(table_->integer("step_changes", 0, std::numeric_limits<std::int32_t>::max()))};
    has_row_ = table_->next();
  }
}

std::optional<Eigen::Matrix3d> MountingTruthReader::mounting(std::uint32_t radar, double t_s) {
  read_until(t_s);
  const auto angles = angles_.find(radar);
  const RadarConfig* const config = vehicle_.radar(radar);
  if (angles == angles_.end() || config == nullptr) return std::nullopt;
  const TrueAngles& is = angles->second;
  return geometry::sensor_to_vehicle(config->mounting_pose, is.yaw_rad, is.pitch_rad, is.roll_rad) *
         geometry::sensor_to_vehicle(config->mounting_pose, 0.0, 0.0, 0.0).transpose();
}

judge::MountingTruth MountingTruthReader::at(std::uint32_t radar, double t_s) {
  judge::MountingTruth truth;
  truth.speed_scale = drive_.speed_scale_seen_by(radar);
  const std::optional<Eigen::Matrix3d> rotation = mounting(radar, t_s);
  if (!rotation) return truth;
  truth.has_rotation = true;
  truth.rotation = car_.load_rotation(0.0) * *rotation;
  truth.load_pitch_rad = car_.load_pitch_at(t_s) - car_.load_pitch_at(0.0);
  truth.step_changes = angles_.at(radar).step_changes;
  return truth;
}

std::optional<bool> MountingTruthReader::is_misaligned(std::uint32_t radar, double t_s) {
  const std::optional<Eigen::Matrix3d> rotation = mounting(radar, t_s);
  const RadarConfig* const config = vehicle_.radar(radar);
  if (!rotation || config == nullptr) return std::nullopt;
  const TrueAngles& own = angles_.at(radar);
  const Eigen::Vector3d about_vehicle = geometry::fixed_axes_angles(*rotation);
  const AlignmentTolerance& tolerance = config->tolerance;
  const auto is_beyond = [](double own_rad, double about_vehicle_rad, double tolerance_rad) {
    return std::abs(own_rad) > tolerance_rad || std::abs(about_vehicle_rad) > tolerance_rad;
  };
  return is_beyond(own.yaw_rad, about_vehicle(0), tolerance.yaw_rad) ||
         is_beyond(own.pitch_rad, about_vehicle(1), tolerance.pitch_rad) ||
         is_beyond(own.roll_rad, about_vehicle(2), tolerance.roll_rad);
}

}  // namespace boresight::score
