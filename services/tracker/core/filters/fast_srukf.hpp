// Fast square-root unscented Kalman filters: the motion is linear, so only the update needs sigma points (Liang and Guo
// 2016). All forms give the result of the full form but for rounding.
#pragma once

#include "services/tracker/core/filters/linear_measurement.hpp"
#include "services/tracker/core/filters/linear_prediction.hpp"
#include "services/tracker/core/filters/srukf.hpp"
#include "services/tracker/core/filters/structured_update.hpp"

namespace boresight::tracking::filters {

enum class FastForm {
  kPublished,   ///< prediction by QR, update by all sigma points (Liang and Guo 2016)
  kCovariance,  ///< prediction by a covariance and its Cholesky root, structured update: the quickest
  kPureRoot,    ///< prediction by QR, structured update by QR: square roots throughout
};

template <typename Real, FastForm Form>
class FastSquareRootUnscented {
 public:
  explicit FastSquareRootUnscented(const Gaussian<Real, 6>& state, const SigmaPointParameters& parameters = {})
      : sigma_(parameters), is_valid_(root_of(state, state_)) {}

  /// False if the root is not that of a positive definite covariance, or a value is not finite. The filter must not be
  /// used then. So does each update.
  template <typename Motion>
  [[nodiscard]] bool predict(const Motion& motion) {
    if constexpr (Form == FastForm::kPublished) {
      return predict_root_by_qr(state_, motion);
    } else if constexpr (Form == FastForm::kCovariance) {
      return predict_root_by_cholesky(state_, motion);
    } else {
      return predict_root_by_axes(state_, motion);
    }
  }

  template <int M>
  [[nodiscard]] bool update(const PolarMeasurement<Real, M>& measurement, const Vector<Real, M>& value,
                            const Noise<Real, M>& noise) {
    if constexpr (Form == FastForm::kPublished) {
      return update_root_by_sigma_points(state_, sigma_, measurement, value, noise);
    } else {
      constexpr InnovationRoot kHow =
          Form == FastForm::kCovariance ? InnovationRoot::kByCholesky : InnovationRoot::kByQr;
      return update_root_by_moving_points<kHow>(state_, sigma_, measurement, value, noise);
    }
  }

  /// Without sigma points, which a linear measurement does not need.
  template <int M>
  [[nodiscard]] bool update(const LinearMeasurement<Real, 6, M>& measurement, const Vector<Real, M>& value,
                            const Noise<Real, M>& noise) {
    const Matrix<Real, M, 6> seen = measurement.matrix * state_.root;
    Matrix<Real, 6 + M, M> rows;
    rows.template topRows<6>() = seen.transpose();
    rows.template bottomRows<M>() = noise.root.transpose();
    Matrix<Real, M, M> innovation_root;
    qr_root(rows, innovation_root);
    const Vector<Real, M> innovation = measurement.innovation(value, measurement.expected(state_.mean));
    return apply_gain<Real, 6, M>(state_, innovation_root, state_.root * seen.transpose(), innovation);
  }

  [[nodiscard]] Gaussian<Real, 6> gaussian() const { return gaussian_of(state_); }
  [[nodiscard]] const RootGaussian<Real, 6>& root() const { return state_; }
  void shift(const Vector<Real, 6>& change) { state_.mean += change; }
  [[nodiscard]] bool is_valid() const { return is_valid_; }

 private:
  RootGaussian<Real, 6> state_;
  SigmaPoints<Real, 6> sigma_;
  bool is_valid_;
};

}  // namespace boresight::tracking::filters
