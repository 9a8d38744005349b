// Measured definitions of what a false mover is: by its place, its range rate and other detections of its scan.
#pragma once

#include "tests/benchmarks/realism/common/observed_scan.hpp"

namespace boresight::bench::realism {

/// A deviation as wide as a range rate that was resolved wrongly.
[[nodiscard]] bool is_ambiguous_width(double deviation_mps);

/// Off by such a width, and on the other side of zero than a stationary reflector in this direction.
[[nodiscard]] bool is_doppler_ambiguity(const ObservedDetection& d);

/// sin(azimuth) of the measured azimuth ambiguity.
inline constexpr double kSineStep = 0.72;

/// A stationary detection of the same range and range rate lies at this distance of sin(azimuth).
[[nodiscard]] bool is_ambiguous_azimuth(const ObservedScan& scan, const ObservedDetection& mover, double step);

/// Whether a stationary detection has the range (± 0.5 m) and range rate (± 0.3 m/s) of the false mover.
[[nodiscard]] bool is_at_range_and_rate(const ObservedDetection& stationary, const ObservedDetection& mover);

/// Range and range rate of a labelled detection of the same scan, over 4° beside it.
[[nodiscard]] bool is_beside_object(const ObservedScan& scan, const ObservedDetection& mover);

/// Range (± 3 m) and range rate (± 0.6 m/s) of a moving object in view, detected or not, over 4° beside its centre.
[[nodiscard]] bool is_beside_tracked_object(const ObservedScan& scan, const ObservedDetection& mover);

/// Beyond a moving object at its range rate (± 0.6 m/s), within 3° of its direction turned by `turn_rad`.
[[nodiscard]] bool is_behind_object(const ObservedScan& scan, const ObservedDetection& mover, double turn_rad);

/// Twice the range (± 3 m) and twice the range rate (± 0.6 m/s) of a moving object, within 3° of its direction.
[[nodiscard]] bool is_at_twice_the_range(const ObservedScan& scan, const ObservedDetection& mover);

/// Within 1.5 m of a labelled detection, range rate within 1 m/s: the unlabelled rest of an object.
[[nodiscard]] bool is_rest_of_object(const ObservedScan& scan, const ObservedDetection& mover);

}  // namespace boresight::bench::realism
