#include "services/alignment_estimator/core/plate/parabola.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace boresight::alignment::plate {

bool fit_parabola(std::span<const double> t, std::span<const double> a, std::span<const double> weights,
                  Parabola& out) {
  double low = 0.0, high = 0.0, heaviest = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    low = heaviest == 0.0 ? t[i] : std::min(low, t[i]);
    high = heaviest == 0.0 ? t[i] : std::max(high, t[i]);
    heaviest = std::max(heaviest, weights[i]);
  }
  if (!(high > low)) return false;
  // Solved over x = (t − middle) / half in −1…1 and with weights up to 1, where the normal equations are well
  // conditioned.
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    const double x = (t[i] - middle) / half, w = weights[i] / heaviest;
    const Eigen::Vector3d row(x * x, x, 1.0);
    normal += w * row * row.transpose();
    right += w * a[i] * row;
  }
  Eigen::Matrix3d inverse;
  bool invertible = false;
  double determinant = 0.0;
  normal.computeInverseAndDetWithCheck(inverse, determinant, invertible, 1e-12);
  if (!invertible || !inverse.allFinite()) return false;
  Eigen::Matrix3d back;                                // coefficients over x → over t
  back << 1.0 / (half * half), 0.0, 0.0,               //
      -2.0 * middle / (half * half), 1.0 / half, 0.0,  //
      middle * middle / (half * half), -middle / half, 1.0;
  out.b = back * (inverse * right);
  out.covariance = back * inverse * back.transpose() / heaviest;
  return out.b.allFinite();
}

}  // namespace boresight::alignment::plate
