#include "services/common/geometry/so3.hpp"

#include <Eigen/LU>

namespace boresight::geometry {

Eigen::Matrix3d euler_gradient_inverse(double yaw_rad, double pitch_rad) {
  return euler_gradient(yaw_rad, pitch_rad).inverse();
}

}  // namespace boresight::geometry
