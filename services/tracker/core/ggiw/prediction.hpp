// A component as one scan is expected to show it, and the likelihood of a cell under it.
//
// The likelihood is collapsed: place, velocity, extent and rate of detections are integrated out in closed form
// (Granström and Orguner 2012, (27)…(33); Granström, Fatemi and Svensson 2020, table I). The range rates ṙᵢ = uᵢᵀ v +
// noise enter as an information update of the velocity that is left after the positions:
//   p(ṙ | v ~ N(v̂, C)) = N(0; …) with Λ = Σ uᵢuᵢᵀ / σ², d = Σ uᵢṙᵢ / σ² − Λ v̂ and χ² = Σ (ṙᵢ − uᵢᵀv̂)² / σ² − dᵀ(I +
//   CΛ)⁻¹C d.
#pragma once

#include <array>
#include <cstddef>

#include "services/tracker/core/ggiw/component.hpp"

namespace boresight::tracking {

/// Where an object's detections lie, by one reading of what the object is.
template <typename Real>
struct Reading {
  Real weight = 1;                 ///< its probability
  Vector2<Real> offset_m;          ///< of the middle of the detections from the tracked point
  Symmetric2<Real> covariance_m2;  ///< of the offset
  bool knows_scatter = false;      ///< detections scatter with `scatter_m2` and not with the extent
  Symmetric2<Real> scatter_m2;
};

/// What the sensor of a scan is to an object at its predicted place.
template <typename Real>
struct View {
  static constexpr std::size_t kMaxReadings = 3;
  Real detection_probability = 0;  ///< in view, not blind to its range rate
  Real exposure = 1;               ///< expected number of detections relative to the nominal range
  Symmetric2<Real> noise_m2;       ///< of one position
  Real range_rate_variance = 0;    ///< m²/s²; 0: range rates are not used
  Vector2<Real> turn_mps;          ///< what an unknown turn rate pretends to be velocity: one standard deviation
  Real spread = Real(0.25);        ///< detections scatter with spread · X
  Real held = 1;                   ///< variance of the mean of detections over several scans, relative to white ones
  Real source_more = Real(0.25);   ///< chance that a source of clutter gives one more detection
  Real source_wander_m2 = 0;       ///< variance of the place of a source of clutter about its predicted one
  Real source_seen = 1;            ///< chance that a source of clutter is there for this radar, too
  Real evidence_share = 1;         ///< of a scan's log likelihood of lasting classes: scans are not independent
  std::array<Reading<Real>, kMaxReadings> readings{};  ///< weights sum to 1
  std::size_t number_of_readings = 1;
};

/// A scan that shows nothing of a component.
template <typename Real>
class Absence {
 public:
  Absence() = default;
  Absence(const Component<Real>& component, const View<Real>& view);

  /// 1 − P_D + P_D · p(no detection | seen): "detected, but no point" included.
  [[nodiscard]] Real probability() const { return probability_; }
  /// The component after the scan.
  [[nodiscard]] Component<Real> after(const Component<Real>& component) const;
  /// log p(no detection | seen)
  [[nodiscard]] Real log_none() const { return log_none_; }
  /// log(β + exposure) of the rate's gamma.
  [[nodiscard]] Real log_rate_step() const { return log_rate_step_; }

 private:
  Real exposure_ = 1, detection_probability_ = 0, log_rate_step_ = 0, log_none_ = 0, probability_ = 1;
};

template <typename Real>
class Prediction {
 public:
  Prediction() = default;
  Prediction(const Component<Real>& component, const View<Real>& view);

  /// log of P_D · p(cell | component) over the product of the cell's clutter densities; n ≥ 1, fractions allowed.
  [[nodiscard]] Real log_likelihood(const Cell<Real>& cell);
  /// The density of one measurement's place and range rate times the expected number, over its clutter density; log.
  [[nodiscard]] Real log_intensity(const Measurement<Real>& z) const;
  /// Squared Mahalanobis distances of place and of range rate to the prediction of one measurement.
  [[nodiscard]] Real place_distance(const Vector2<Real>& position_m) const;
  [[nodiscard]] Real range_rate_distance(const Measurement<Real>& z) const;
  /// Of Absence.
  [[nodiscard]] Real missed() const { return absence_.probability(); }

  /// The cell as one measurement of the tracked point: the readings by their moments.
  struct Centre {
    Vector2<Real> position_m;
    Symmetric2<Real> covariance_m2;
    Real by_extent = 1;  ///< probability that the detections scatter with the extent
  };
  [[nodiscard]] Centre centre(const Cell<Real>& cell);
  /// The component with the cell as its detections.
  [[nodiscard]] Component<Real> updated(const Component<Real>& component, const Cell<Real>& cell);
  /// The component after a scan that shows nothing of it.
  [[nodiscard]] Component<Real> missed_component(const Component<Real>& component) const {
    return absence_.after(component);
  }

  /// How much likelier so many detections are of a source of clutter than of an object; log.
  [[nodiscard]] Real log_source_ratio(Real n);
  void move_to(const Vector2<Real>& position_m) { position_m_ = position_m; }
  [[nodiscard]] const Vector2<Real>& position_m() const { return position_m_; }
  [[nodiscard]] const Vector2<Real>& velocity_mps() const { return velocity_mps_; }
  [[nodiscard]] const Symmetric2<Real>& velocity_covariance() const { return velocity_covariance_; }
  [[nodiscard]] Symmetric2<Real> extent_m2() const { return (Real(1) / (extent_dof_ - Real(6))) * extent_scale_; }
  [[nodiscard]] const Symmetric2<Real>& scatter_m2() const { return scatter_; }
  [[nodiscard]] const Symmetric2<Real>& position_covariance() const { return position_covariance_; }
  [[nodiscard]] Real range_rate_variance() const { return view_.range_rate_variance; }
  [[nodiscard]] Real detection_probability() const { return detection_probability_; }
  /// Squared semi-axes of the gate for a squared distance of 1, along the axes.
  [[nodiscard]] const Symmetric2<Real>& measurement_covariance() const { return places_[0].covariance_m2; }
  [[nodiscard]] std::uint32_t label() const { return label_; }

 private:
  static constexpr std::size_t kTabulated = 64;  // beyond it, the gamma functions are computed by a series
  static constexpr auto kLastTabulated = static_cast<Real>(kTabulated - 1);

  void tabulate(std::size_t n);
  [[nodiscard]] Real interpolated(const std::array<Real, kTabulated>& table, Real n);
  /// Of `more` detections than tabulated: gamma function of the rate.
  [[nodiscard]] Real rates_beyond_table(Real more) const;
  /// Terms of the likelihood that depend on the number of detections alone.
  [[nodiscard]] Real terms_by_count(Real n);
  /// log p(n | object).
  [[nodiscard]] Real log_count(Real n);
  [[nodiscard]] Real log_class_weight(const Cell<Real>& cell);
  /// How much likelier the cell's place is of a source of clutter, which wanders about what motion predicts, than of an
  /// object; at most 1, since an object that is elsewhere may have turned.
  [[nodiscard]] Real source_place_ratio(const Cell<Real>& cell) const;
  /// Probabilities of the classes before the scan times the likelihood of the number of detections and their place,
  /// relative to an object's.
  struct ClassWeights {
    Real side_lobe, lasting_source, sum;
  };
  [[nodiscard]] ClassWeights class_weights(const Cell<Real>& cell);

  /// One measurement as expected by one reading of what the object is.
  struct Place {
    Vector2<Real> offset_m;
    Symmetric2<Real> prior_m2;    ///< of the middle of the detections: place and offset
    bool knows_scatter = false;   ///< `scatter_m2` does not depend on the extent
    Symmetric2<Real> scatter_m2;  ///< of one detection, noise included
    Symmetric2<Real> covariance_m2, information;
    Real log_weight = 0, log_half_determinant = 0;
  };
  /// log of the likelihood of a cell by one reading, without clutter and classes of sources.
  [[nodiscard]] Real log_by(const Place& place, const Cell<Real>& cell);
  /// Of the readings, given that the cell is the object's; they sum to 1.
  [[nodiscard]] std::array<Real, View<Real>::kMaxReadings> weights_of(const Cell<Real>& cell);

  View<Real> view_;
  std::uint32_t label_ = 0;
  Vector2<Real> position_m_, velocity_mps_;
  Symmetric2<Real> position_covariance_, velocity_covariance_;
  Matrix2<Real> position_velocity_covariance_;
  Symmetric2<Real> scatter_;       // R = spread · X + noise: of one detection
  Symmetric2<Real> held_scatter_;  // held · spread · X + noise: of one, where its place is held from scan to scan
  Symmetric2<Real> extent_root_;   // X^½
  Matrix2<Real> shape_;            // B = X^½ R^−½
  std::array<Place, View<Real>::kMaxReadings> places_;
  Symmetric2<Real> extent_scale_;
  Real extent_dof_ = 8;
  Real rate_shape_ = 1, rate_inverse_scale_ = 1, log_expected_ = 0;
  Real detection_probability_ = 0;
  Absence<Real> absence_;
  SourceClasses<Real> source_;
  // Terms of the likelihood that depend on the number of detections alone, and log p(n | object).
  std::array<Real, kTabulated> by_count_, log_count_;  // the first `tabulated_`
  std::size_t tabulated_ = 0;
  Real log_exposure_ = 0, extent_terms_ = 0, per_detection_ = 0, constant_ = 0;
  Real log_detection_ = 0, log_range_rate_ = 0;  // of P_D; of 2π and the variance of a range rate
  // Of a source of clutter, found when first asked for: log of one detection and of each more, over p(seen).
  bool knows_source_ = false;
  Real log_source_one_ = 0, log_source_more_ = 0;
};

}  // namespace boresight::tracking
