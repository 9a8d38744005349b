// Section 5: noise across the line of sight.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// Range rates of stationary detections scatter by azimuth noise, too: with the sensor's speed v across the line of
/// sight, var(range rate) = var(noise of the range rate) + v² · var(azimuth). A line through the robust variances by v²
/// parts the two. Beside it, how far a car's detections lie across the line of sight.
class AzimuthNoise {
 public:
  /// Azimuth off boresight: up to 20°, 20–50°, 60–70°.
  static constexpr std::size_t kBands = 3;
  /// Ranges of cars: 20–50 m, 50–100 m.
  static constexpr std::size_t kCarRanges = 2;

  void add(const ObservedScan& scan);
  /// Ends a drive: object numbers begin again.
  void end_drive();
  void merge(const AzimuthNoise& other);

  /// Standard deviation of the azimuth; 0 if the range rates do not scatter more with the speed.
  [[nodiscard]] double azimuth_std_deg(std::size_t band) const;
  /// Robust standard deviation of cars' detections across the line of sight, about the median of one car and radar.
  [[nodiscard]] double car_std_m(std::size_t range) const { return car_across_m_[range].robust_std(); }

 private:
  static constexpr std::size_t kSpeeds = 10;  // of 3 m/s
  struct Bin {
    Samples deviation_mps;
    double squared_speeds = 0.0;  // sum, m²/s²
  };
  std::array<std::array<Bin, kSpeeds>, kBands> bins_;
  std::array<Samples, kCarRanges> car_across_m_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::size_t>, std::vector<double>> open_;  // radar, object, range
};

}  // namespace boresight::bench::realism
