// Where the vehicle is in a frame that stands still: what is stationary is kept there and need not be moved at all.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/LU>

#include "services/common/geometry/ego_step.hpp"

namespace boresight::ghosts {

class Odometry {
 public:
  /// To the instant of a scan. False if the clock jumped (back by over a second, or on by over two): what was kept in
  /// the frame is worth nothing then. Radars' scans may be a few milliseconds out of order.
  [[nodiscard]] bool advance(std::int64_t time_ns, double speed_mps, double yaw_rate_radps) {
    const double elapsed_s = static_cast<double>(time_ns - now_ns_) * 1e-9;
    const bool continuous = started_ && elapsed_s > -1.0 && elapsed_s < 2.0;
    started_ = true;
    now_ns_ = time_ns;
    if (!continuous) {
      position_m_.setZero();
      to_vehicle_.setIdentity();
      return false;
    }
    const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, elapsed_s);
    position_m_ += to_vehicle_.transpose() * step.translation_m;
    to_vehicle_ = step.to_new * to_vehicle_;
    // The product of many rotations shrinks slowly.
    to_vehicle_ *= 1.0 / std::sqrt(to_vehicle_.determinant());
    return true;
  }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  [[nodiscard]] const Eigen::Vector2d& position_m() const { return position_m_; }
  [[nodiscard]] Eigen::Vector2d point_to_vehicle(const Eigen::Vector2d& p) const {
    return to_vehicle_ * (p - position_m_);
  }
  [[nodiscard]] Eigen::Vector2d point_to_frame(const Eigen::Vector2d& p) const {
    return position_m_ + to_vehicle_.transpose() * p;
  }
  [[nodiscard]] Eigen::Vector2d vector_to_vehicle(const Eigen::Vector2d& v) const { return to_vehicle_ * v; }
  [[nodiscard]] Eigen::Vector2d vector_to_frame(const Eigen::Vector2d& v) const { return to_vehicle_.transpose() * v; }

 private:
  bool started_ = false;
  std::int64_t now_ns_ = 0;
  Eigen::Vector2d position_m_{0.0, 0.0};
  Eigen::Matrix2d to_vehicle_ = Eigen::Matrix2d::Identity();
};

}  // namespace boresight::ghosts
