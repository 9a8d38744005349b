// Measurements of the plate at each of its tilts.
#pragma once

#include <array>
#include <cstddef>

namespace boresight::alignment::plate {

inline constexpr std::size_t kMaxTilts = 11;         ///< Burza 2025, §7: N ≤ 11
inline constexpr std::size_t kMinScansPerTilt = 10;  ///< Burza 2025, §7: K = 10…50
inline constexpr std::size_t kMaxScansPerTilt = 50;
inline constexpr std::size_t kFewestTilts = 3;      ///< a parabola has three coefficients
inline constexpr double kLargestTilt_rad = 0.3491;  ///< 20°: beyond, the plate is outside the main lobe

/// Running mean and variance (Welford), without cancellation for a large mean.
class Welford {
 public:
  void add(double sample) {
    ++count_;
    const double difference = sample - mean_;
    mean_ += difference / static_cast<double>(count_);
    squares_ += difference * (sample - mean_);
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }
  /// Sample variance (divided by n − 1); 0 with fewer than two samples.
  [[nodiscard]] double variance() const { return count_ < 2 ? 0.0 : squares_ / static_cast<double>(count_ - 1); }

 private:
  std::size_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// The scans at one tilt. A positive tilt is toward the ground: the ray that meets the plate squarely descends by that
/// angle on its way from the radar, and the plate's upper edge leans away from the radar. Tilts count from the position
/// in which the plate is square to the radar's nominal boresight.
struct TiltMeasurement {
  double tilt_rad = 0.0;
  std::size_t scans = 0;  ///< number of valid entries in the columns
  std::array<double, kMaxScansPerTilt> amplitude_db{};
  std::array<double, kMaxScansPerTilt> azimuth_rad{};  ///< sensor frame, + left
  Welford amplitude;
  Welford azimuth;

  /// Adds one scan's plate; finite values only. False, and nothing is added, if kMaxScansPerTilt scans are stored.
  bool add(double scan_amplitude_db, double scan_azimuth_rad) {
    if (scans == kMaxScansPerTilt) return false;
    amplitude_db[scans] = scan_amplitude_db;
    azimuth_rad[scans] = scan_azimuth_rad;
    ++scans;
    amplitude.add(scan_amplitude_db);
    azimuth.add(scan_azimuth_rad);
    return true;
  }
};

/// A whole run.
struct Measurements {
  std::size_t number_of_tilts = 0;
  std::array<TiltMeasurement, kMaxTilts> tilts{};
};

}  // namespace boresight::alignment::plate
