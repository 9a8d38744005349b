// Which share of each object other tracked objects hide from the radar of a scan. Walls and parked vehicles are
// unknown.
//
// An object A covers the azimuths a₁ … a₂ of its box, and B the azimuths b₁ … b₂. With the variance σ² of the
// difference of their azimuths, the share of B that A covers is
//
//     (1)   c = 1/(b₂ − b₁) ∫ Φ((x − a₁)/σ) − Φ((x − a₂)/σ) dx,   from b₁ to b₂,   ∫ Φ(t) dt = t Φ(t) + φ(t).
//
// A hides it only if B is beyond: on a line of sight to both, the middle of B is farther than the far side of A. With
// the existence r of each object in front, and all of them independent, the hidden share of B is
//
//     (2)   h = 1 − Π (1 − r_A P(B beyond A) c_A).
//
// Objects whose boxes lie in each other do not hide each other.
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/ggiw/planar.hpp"
#include "services/tracker/core/model/box_estimator.hpp"

namespace boresight::tracking {

class Occlusion {
 public:
  explicit Occlusion(std::size_t max_objects);

  /// Begins a scan of the sensor at this place.
  void begin_scan(const Vector2<double>& sensor_m);
  /// Beyond the capacity, an object hides nothing and nothing hides it.
  void add(std::uint32_t label, double existence, const Box& box);
  /// h of (2), of the objects added so far; 0 of one that was not added. From `enough` on it is a lower bound.
  [[nodiscard]] double hidden_share(std::uint32_t label, double enough = 1.0) const;

 private:
  /// An object as seen from the sensor.
  struct Outline {
    std::uint32_t label;
    double existence;
    Vector2<double> centre_m;                          // from the sensor
    double cosine, sine, half_length_m, half_width_m;  // of the box
    double range_m, range_variance_m2;
    double middle_rad, half_rad, azimuth_variance_rad2;
    Vector2<double> sight;  // unit vector to the middle
  };
  /// Where a line of sight enters and leaves a box, as multiples of its vector.
  struct Chord {
    double enter, leave;
    [[nodiscard]] double middle() const { return 0.5 * (enter + leave); }
  };
  [[nodiscard]] static Chord chord(const Outline& outline, const Vector2<double>& sight);
  /// Lines of sight to two outlines, for a factor of (2).
  struct Pair {
    double middle_rad;  // of b, relative to that of a
    double std_rad, range_std;
    Chord a, b;
  };
  /// False if neither hides anything of the other.
  [[nodiscard]] static bool are_in_line(const Outline& a, const Outline& b, Pair& pair);

  Vector2<double> sensor_m_;
  std::vector<Outline> outlines_;
  FixedTable index_;  // of outlines_ by label
};

}  // namespace boresight::tracking
