#include "services/simulator/radar/cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boresight::simulator::radar {

namespace {

double size_of(double cell) {
  return cell > 0.0 ? cell : 1e-6;
}

/// The centroid, weighted by power, of the echoes of one detection.
class Centroid {
 public:
  void add(const Echo& e) {
    const double power = std::pow(10.0, 0.1 * e.power_db);
    power_ += power;
    range_ += power * e.range_m;
    azimuth_ += power * e.azimuth_rad;
    elevation_ += power * e.elevation_rad;
    rate_ += power * e.range_rate_mps;
  }
  void write(Echo& e) const {
    e.range_m = range_ / power_;
    e.azimuth_rad = azimuth_ / power_;
    e.elevation_rad = elevation_ / power_;
    e.range_rate_mps = rate_ / power_;
    e.power_db = 10.0 * std::log10(power_);
  }

 private:
  double power_ = 0.0, range_ = 0.0, azimuth_ = 0.0, elevation_ = 0.0, rate_ = 0.0;
};

}  // namespace

bool resolved(const ResolutionCell& cell, const Echo& a, const Echo& b) {
  return std::abs(a.range_m - b.range_m) >= size_of(cell.range_m) ||
         std::abs(a.azimuth_rad - b.azimuth_rad) >= size_of(cell.azimuth_rad) ||
         std::abs(a.range_rate_mps - b.range_rate_mps) >= size_of(cell.range_rate_mps);
}

Echo Cells::take(std::size_t strongest, const std::vector<Echo>& echoes) {
  Echo merged = echoes[strongest];
  taken_[strongest] = 1;
  const double reach = size_of(cell_.range_m);
  Centroid centroid;
  bool alone = true;
  const auto try_one = [&](std::size_t i) {
    if (std::abs(echoes[i].range_m - echoes[strongest].range_m) >= reach) return false;
    if (taken_[i] != 0 || resolved(cell_, echoes[i], echoes[strongest])) return true;
    if (alone) centroid.add(echoes[strongest]);
    alone = false;
    centroid.add(echoes[i]);
    taken_[i] = 1;
    return true;
  };
  for (std::size_t i = strongest + 1; i < echoes.size() && try_one(i); ++i) {
  }
  for (std::size_t i = strongest; i > 0 && try_one(i - 1); --i) {
  }
  if (!alone) centroid.write(merged);
  return merged;
}

void Cells::merge(std::vector<Echo>& echoes) {
  std::sort(echoes.begin(), echoes.end(), [](const Echo& a, const Echo& b) {
    return a.range_m != b.range_m ? a.range_m < b.range_m : a.key < b.key;
  });
  by_power_.resize(echoes.size());
  std::iota(by_power_.begin(), by_power_.end(), 0u);
  std::sort(by_power_.begin(), by_power_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return echoes[a].power_db != echoes[b].power_db ? echoes[a].power_db > echoes[b].power_db : a < b;
  });
  taken_.assign(echoes.size(), 0);
  merged_.clear();
  for (const std::uint32_t i : by_power_) {
    if (taken_[i] == 0) merged_.push_back(take(i, echoes));
  }
  echoes.swap(merged_);
}

}  // namespace boresight::simulator::radar
