// Errors of one parameter at one time of many drives: rms, NEES (normalised estimation error squared, 1 if the stated
// std is right) and the share within the stated 95 % intervals. What the radars of one drive have in common is no
// independent evidence, so intervals resample whole drives.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/benchmarks/alignment/common/runner.hpp"
#include "tests/benchmarks/common/intervals.hpp"

namespace boresight::bench {

class AxisErrors {
 public:
  void begin_drive() { drives_.push_back({}); }
  void add(double error, double std) {
    constexpr double kInterval95_stds = 1.96;
    const double z = error / std;
    Sums& sums = drives_.back();
    sums.count += 1.0;
    sums.squares += error * error;
    sums.normalised += z * z;
    sums.covered += std::abs(z) <= kInterval95_stds ? 1.0 : 0.0;
    sizes_.push_back(std::abs(error));
  }
  [[nodiscard]] double count() const { return total().count; }
  [[nodiscard]] double rms() const { return rms_of(total()); }
  [[nodiscard]] double nees() const { return total().normalised / total().count; }
  [[nodiscard]] double covered_percent() const { return covered_of(total()); }
  [[nodiscard]] double median_size() const { return median(sizes_); }
  [[nodiscard]] double size_quantile(double share) const { return quantile(sizes_, share); }

  [[nodiscard]] Interval rms_interval() const { return interval(rms_of); }
  [[nodiscard]] Interval nees_interval() const {
    return interval([](const Sums& s) { return s.normalised / s.count; });
  }
  [[nodiscard]] Interval covered_interval() const { return interval(covered_of); }
  /// Of rms() / other.rms(); both have the same drives.
  [[nodiscard]] Interval ratio_interval(const AxisErrors& other) const {
    return bootstrap(drives_.size(), [&](const std::vector<std::size_t>& picks) {
      return rms_of(total(picks)) / rms_of(other.total(picks));
    });
  }

 private:
  struct Sums {
    double count = 0.0, squares = 0.0, normalised = 0.0, covered = 0.0;
    void add(const Sums& other) {
      count += other.count;
      squares += other.squares;
      normalised += other.normalised;
      covered += other.covered;
    }
  };
  static double rms_of(const Sums& s) { return std::sqrt(s.squares / s.count); }
  static double covered_of(const Sums& s) { return 100.0 * s.covered / s.count; }
  [[nodiscard]] Sums total() const {
    Sums sum;
    for (const Sums& drive : drives_) sum.add(drive);
    return sum;
  }
  [[nodiscard]] Sums total(const std::vector<std::size_t>& picks) const {
    Sums sum;
    for (const std::size_t pick : picks) sum.add(drives_[pick]);
    return sum;
  }
  template <typename Figure>
  [[nodiscard]] Interval interval(Figure&& figure) const {
    return bootstrap(drives_.size(), [&](const std::vector<std::size_t>& picks) { return figure(total(picks)); });
  }
  std::vector<Sums> drives_;
  std::vector<double> sizes_;
};

/// Of all four parameters; roll only where the method reports it as observable.
struct DriveErrors {
  std::array<AxisErrors, 4> axes;

  void add_drive(const Snapshot& snapshot, const std::vector<std::size_t>& radars) {
    for (AxisErrors& axis : axes) axis.begin_drive();
    for (const std::size_t r : radars) {
      const RadarError& radar = snapshot.radars[r];
      for (std::size_t p = 0; p < axes.size(); ++p) {
        if (p == kRoll && (radar.observable & kParameterBits[p]) == 0) continue;
        const auto place = static_cast<int>(p);
        axes[p].add(radar.error(place), radar.std(place));
      }
    }
  }
  void add_drive(const Snapshot& snapshot) {
    std::vector<std::size_t> all;
    for (std::size_t r = 0; r < snapshot.radars.size(); ++r) all.push_back(r);
    add_drive(snapshot, all);
  }
  [[nodiscard]] const AxisErrors& of(int parameter) const { return axes[static_cast<std::size_t>(parameter)]; }
  /// The parameter with the largest NEES, and that with the smallest covered share.
  [[nodiscard]] int least_consistent() const {
    return worst([](const AxisErrors& axis) { return axis.nees(); });
  }
  [[nodiscard]] int least_covered() const {
    return worst([](const AxisErrors& axis) { return -axis.covered_percent(); });
  }

 private:
  template <typename Badness>
  [[nodiscard]] int worst(Badness&& badness) const {
    // What is not a number is worst of all.
    const auto rank = [&](int p) {
      const double bad = badness(of(p));
      return std::isnan(bad) ? std::numeric_limits<double>::infinity() : bad;
    };
    int worst = kYaw;
    for (int p = 0; p < kYaw; ++p) {
      if (of(p).count() > 0.0 && rank(p) > rank(worst)) worst = p;
    }
    return worst;
  }
};

}  // namespace boresight::bench
