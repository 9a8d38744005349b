// False moving detections at a doubly stochastic rate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "services/simulator/radar/returns/place.hpp"
#include "services/simulator/radar/returns/strength.hpp"

namespace boresight::simulator::radar {

/// A standard normal process in time with correlation a^Δt: a moving average of white noise at knots, with geometric
/// weights, linear between knots. Each value follows from the seed alone.
class SlowNormal {
 public:
  explicit SlowNormal(double correlation_after_1s)
      : step_(std::pow(std::clamp(correlation_after_1s, 0.0, 0.98), kKnot_s)) {
    for (double weight = 1.0; weight > kSmallestWeight; weight *= step_) weights_.push_back(weight);
    double power = 0.0;
    for (const double weight : weights_) power += weight * weight;
    for (double& weight : weights_) weight /= std::sqrt(power);
  }
  [[nodiscard]] double at(double t_s, const Draws& draws) const {
    const double knot = std::floor(t_s / kKnot_s), share = t_s / kKnot_s - knot;
    const auto newest = Draws::kBefore + static_cast<std::uint64_t>(std::max(0.0, knot)) + 1;
    double before = 0.0, after = 0.0;
    for (std::size_t k = 0; k <= weights_.size(); ++k) {
      const double white = draws.always("rate", newest - k).gaussian();
      if (k < weights_.size()) after += weights_[k] * white;
      if (k > 0) before += weights_[k - 1] * white;
    }
    const double variance = (1.0 - share) * (1.0 - share) + share * share + 2.0 * share * (1.0 - share) * step_;
    return ((1.0 - share) * before + share * after) / std::sqrt(variance);
  }

 private:
  static constexpr double kKnot_s = 0.25;
  static constexpr double kSmallestWeight = 0.05;
  double step_;
  std::vector<double> weights_;
};

class FalseMovers {
 public:
  explicit FalseMovers(const FalseMoverSpec& spec) : spec_(spec), level_(spec.correlation_after_1s) {}

  /// Mean number of false movers in a scan at that time: log-normal.
  [[nodiscard]] double rate(double t_s, const Draws& draws) const {
    if (!(spec_.median_per_scan > 0.0)) return 0.0;
    const double spread = std::log(std::max(1.0, spec_.p90_per_scan / spec_.median_per_scan)) / kNormal90;
    return spec_.median_per_scan * std::exp(spread * level_.at(t_s, draws));
  }

  /// Factor of the rate: 1 for a radar that looks along the road, `abeam_factor` for one that looks abeam.
  [[nodiscard]] double direction_factor(const Viewpoint& view, double ego_heading_rad) const {
    const Eigen::Vector2d boresight = view.sensor_to_world.col(0).head<2>().normalized();
    const double cosine = boresight.x() * std::cos(ego_heading_rad) + boresight.y() * std::sin(ego_heading_rad);
    return spec_.abeam_factor + (1.0 - spec_.abeam_factor) * cosine * cosine;
  }

  /// Appends the false movers of a scan. Most are new in each scan, at the present rate. Those that last are born at
  /// the constant rate median · lasting_share and move by their own range rate.
  void add(double t_s, double cycle_time_s, const Draws& draws, const Viewpoint& view, double ego_heading_rad,
           const FieldOfView& fov, const StrengthSpec& strength, std::vector<Echo>& echoes) const {
    Stream present = draws.once("false movers");
    const double share = direction_factor(view, ego_heading_rad);
    const unsigned single =
        present.poisson(std::min(kMostPerScan, share * (1.0 - spec_.lasting_share) * rate(t_s, draws)));
    for (unsigned i = 0; i < single; ++i) {
      Stream stream = draws.once("false mover", i);
      add_one(stream, 0.0, key_of(kSingle, key_of(draws.cycle, i)), view, fov, strength, echoes);
    }
    for (std::uint32_t age = 0; age < kOldest; ++age) {
      const std::uint64_t birth = Draws::kBefore + draws.cycle - age;
      Stream births = draws.always("false births", birth);
      const unsigned count = births.poisson(share * spec_.lasting_share * spec_.median_per_scan);
      for (unsigned i = 0; i < count; ++i) {
        if (length(births) <= age) continue;
        Stream stream = draws.always("lasting", key_of(birth, i));
        add_one(stream, age * cycle_time_s, key_of(kLasting, key_of(birth, i)), view, fov, strength, echoes);
      }
    }
  }

 private:
  static constexpr std::uint32_t kOldest = 40;  // scans
  static constexpr double kMostPerScan = 200.0;
  static constexpr std::uint64_t kSingle = 0xFA15E, kLasting = 0xFA15F;

  /// Length in scans: 2 and more, geometric.
  [[nodiscard]] std::uint32_t length(Stream& births) const {
    const double further = std::max(0.0, spec_.lasting_scans - 2.0);
    if (!(further > 0.0)) return 2;
    return 2 + static_cast<std::uint32_t>(
                   std::min(1000.0, std::log(1.0 - births.uniform()) / std::log(further / (1.0 + further))));
  }

  [[nodiscard]] double deviation_mps(Stream& stream) const {
    constexpr std::array<double, kDeviationBins + 1> kEdges_mps = {1.0, 2.0, 5.0, 10.0, 20.0, 36.0};
    const double sign = stream.uniform() < 0.5 ? -1.0 : 1.0;
    double sum = 0.0;
    for (const double share : spec_.deviation_share) sum += share;
    double rest = stream.uniform() * sum;
    std::size_t bin = 0;
    while (bin + 1 < kDeviationBins && rest >= spec_.deviation_share[bin]) rest -= spec_.deviation_share[bin++];
    return sign * stream.uniform(kEdges_mps[bin], kEdges_mps[bin + 1]);
  }

  void add_one(Stream& stream, double age_s, std::uint64_t key, const Viewpoint& view, const FieldOfView& fov,
               const StrengthSpec& strength, std::vector<Echo>& echoes) const {
    constexpr double kNearest_m = 1.0, kFarthest_m = 100.0;  // bounds of the measured distribution
    Echo e{};
    e.range_m = value_at(stream.uniform(), kFrom10To90, spec_.range_m, kNearest_m, kFarthest_m);
    e.azimuth_rad = stream.uniform(fov.azimuth_min_rad, fov.azimuth_max_rad);
    e.elevation_rad = stream.uniform(fov.elevation_min_rad, fov.elevation_max_rad);
    const bool near_zero = stream.uniform() < spec_.near_zero_share;
    const double zero_mps = stream.uniform(-1.0, 1.0), deviation = deviation_mps(stream);
    e.range_rate_mps = near_zero ? zero_mps : stationary_rate(view, e) + deviation;
    e.range_m += e.range_rate_mps * age_s;
    const double rcs = false_rcs(strength, e.range_m, stream);
    if (e.range_m < kNearest_m || e.range_m > fov.range_max_m) return;
    set_rcs(e, rcs, fov);
    e.truth.provenance = Provenance::kClutter;
    e.truth.cause = Cause::kFalseMover;
    e.key = key;
    echoes.push_back(e);
  }

  FalseMoverSpec spec_;
  SlowNormal level_;
};

}  // namespace boresight::simulator::radar
