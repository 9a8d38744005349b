#include "tests/benchmarks/tracking/headings/judge/heading_judge.hpp"

#include <cmath>

#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::bench::tracking {

void HeadingJudge::add(std::uint32_t object, HeadingSource source, const boresight::tracking::Heading& heading,
                       double truth_rad) {
  const auto [known, is_new] = object_of_.try_emplace(object, objects_.size());
  if (is_new) objects_.emplace_back();
  Sums& sums = objects_[known->second][static_cast<std::size_t>(source)];
  const double error_rad = geometry::wrap_angle(heading.rad - truth_rad);
  sums.number += 1.0;
  sums.squares_rad2 += error_rad * error_rad;
  sums.normalised += error_rad * error_rad / heading.variance_rad2;
}

void HeadingJudge::append(const HeadingJudge& other) {
  objects_.insert(objects_.end(), other.objects_.begin(), other.objects_.end());
}

HeadingJudge::Figures HeadingJudge::figures(HeadingSource source) const {
  std::vector<Sums> of_objects;
  for (const OfObject& object : objects_) {
    const Sums& sums = object[static_cast<std::size_t>(source)];
    if (sums.number > 0.0) of_objects.push_back(sums);
  }
  const auto mean = [&of_objects](const std::vector<std::size_t>& picks, double Sums::*part) {
    double sum = 0.0, number = 0.0;
    for (const std::size_t i : picks) {
      sum += of_objects[i].*part;
      number += of_objects[i].number;
    }
    return number > 0.0 ? sum / number : kNaN;
  };
  std::vector<std::size_t> all(of_objects.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  Figures f;
  f.objects = of_objects.size();
  f.rms_rad = std::sqrt(mean(all, &Sums::squares_rad2));
  f.nees = mean(all, &Sums::normalised);
  f.rms_interval = bootstrap(
      all.size(), [&](const std::vector<std::size_t>& picks) { return std::sqrt(mean(picks, &Sums::squares_rad2)); });
  f.nees_interval =
      bootstrap(all.size(), [&](const std::vector<std::size_t>& picks) { return mean(picks, &Sums::normalised); });
  return f;
}

}  // namespace boresight::bench::tracking
