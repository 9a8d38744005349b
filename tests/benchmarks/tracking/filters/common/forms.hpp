// The compared filters, each as a type.
#pragma once

#include <array>
#include <cstddef>

#include "services/tracker/core/filters/constant_acceleration.hpp"
#include "services/tracker/core/filters/fast_srukf.hpp"
#include "services/tracker/core/filters/kalman.hpp"
#include "services/tracker/core/filters/ukf.hpp"

namespace boresight::bench::filters {

using namespace tracking::filters;

/// In the order of for_each_form().
inline constexpr std::array kFormNames = {"EKF",
                                          "UKF",
                                          "SRUKF, full",
                                          "SRUKF, fast: QR, all points",
                                          "SRUKF, fast: P + Cholesky",
                                          "SRUKF, fast: pure square root"};
inline constexpr std::size_t kForms = kFormNames.size();
inline constexpr std::size_t kFull = 2, kPublished = 3, kCovariance = 4, kPureRoot = 5;

/// Calls `work` with the index and a filter of each form, whose value has no meaning.
template <typename Real, typename Work>
void for_each_form(Work&& work) {
  const Gaussian<Real, 6> any;
  work(std::size_t{0}, ExtendedKalman<Real, 6>(any));
  work(std::size_t{1}, Unscented<Real, 6>(any));
  work(kFull, SquareRootUnscented<Real, 6>(any));
  work(kPublished, FastSquareRootUnscented<Real, FastForm::kPublished>(any));
  work(kCovariance, FastSquareRootUnscented<Real, FastForm::kCovariance>(any));
  work(kPureRoot, FastSquareRootUnscented<Real, FastForm::kPureRoot>(any));
}

}  // namespace boresight::bench::filters
