#include "services/boresight/input/ego_csv.hpp"

#include <fmt/format.h>

namespace boresight::input {

namespace {

enum : std::size_t { kEgoTime, kEgoSpeed, kEgoYawRate };

constexpr std::array<Column, 3> kEgoColumns = {{
    {.name = "t_s", .min = TimeOrder::kMin_s, .max = TimeOrder::kMax_s, .unit = "s", .synonyms = {"t", "time_s"}},
    {.name = "speed_mps", .min = -150.0, .max = 150.0, .unit = "m/s", .synonyms = {"v"}},
    {.name = "yaw_rate_radps", .min = -20.0, .max = 20.0, .unit = "rad/s", .synonyms = {"yaw_rate"}},
}};

}  // namespace

EgoReader::EgoReader(recording::ByteSource& source, const EgoConfig& config, Problems& problems)
    : config_(config), table_(source, kEgoColumns, problems) {}

bool EgoReader::next(EgoMotion& motion, double& time_s) {
  std::array<double, 3> row{};
  while (table_.next(row)) {
    const double newest_s = order_.newest_s();
    if (!order_.accept(row[kEgoTime])) {
      table_.reject(kEgoTime,
                    fmt::format("read {} s after {} s; times may go back by at most {} s and forward by at most {} s",
                                row[kEgoTime], newest_s, TimeOrder::kBack_s, TimeOrder::kForward_s));
      continue;
    }
    table_.accept();
    time_s = row[kEgoTime];
    time_ns_ = nanoseconds_of(table_.text(kEgoTime), time_s);
    motion.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse;
    motion.speed_mps = static_cast<float>(row[kEgoSpeed]);
    motion.speed_std_mps = static_cast<float>(config_.speed_std_mps);
    motion.yaw_rate_radps = static_cast<float>(row[kEgoYawRate]);
    motion.yaw_rate_std_radps = static_cast<float>(config_.yaw_rate_std_radps);
    motion.steering_angle_rad = motion.steering_angle_std_rad = motion.longitudinal_acceleration_mps2 = 0.0F;
    return true;
  }
  return false;
}

}  // namespace boresight::input
