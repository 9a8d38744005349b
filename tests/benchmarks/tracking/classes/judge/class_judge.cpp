#include "tests/benchmarks/tracking/classes/judge/class_judge.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/estimation/unknown.hpp"

namespace boresight::bench::tracking {

using extended_object::kRoadUserClasses;

namespace {

constexpr auto kVan = static_cast<std::size_t>(extended_object::RoadUserClass::kVan);
constexpr std::size_t kJudgedClasses = kRoadUserClasses - 1;

/// The likeliest one of the classes, without that of index `except`.
[[nodiscard]] std::size_t likeliest(const ReportedClasses& p, std::size_t except = kRoadUserClasses) {
  std::size_t best = except == 0 ? 1 : 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    if (k != except && p[k] > p[best]) best = k;
  }
  return best;
}

/// Cases by the object that they are of.
[[nodiscard]] std::vector<std::vector<std::size_t>> by_object(const ClassJudge& judge) {
  std::vector<std::vector<std::size_t>> of_objects(judge.objects());
  for (std::size_t i = 0; i < judge.cases().size(); ++i) of_objects[judge.cases()[i].object].push_back(i);
  return of_objects;
}

template <typename Look>
void each_case(const std::vector<std::vector<std::size_t>>& of_objects, std::span<const std::size_t> picks,
               const ClassJudge& judge, const Look& look) {
  for (const std::size_t object : picks) {
    for (const std::size_t i : of_objects[object]) look(judge.cases()[i]);
  }
}

using Cases = std::vector<std::vector<std::size_t>>;

[[nodiscard]] double balanced_accuracy(const ClassJudge& judge, const Cases& of_objects,
                                       std::span<const std::size_t> picks) {
  std::array<double, kRoadUserClasses> right{}, number{};
  each_case(of_objects, picks, judge, [&](const ClassCase& c) {
    right[c.true_class] += c.right / c.lists;
    number[c.true_class] += 1.0;
  });
  double sum = 0.0;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    if (k == kVan) continue;
    if (number[k] <= 0.0) return kNaN;
    sum += right[k] / number[k];
  }
  return sum / static_cast<double>(kJudgedClasses);
}

[[nodiscard]] Calibration calibration(const ClassJudge& judge, const Cases& of_objects,
                                      std::span<const std::size_t> picks) {
  std::array<double, kRoadUserClasses> number{};
  each_case(of_objects, picks, judge, [&](const ClassCase& c) { number[c.true_class] += 1.0; });
  std::array<ClassCase::Bin, ClassCase::kBins> bins{};
  double all = 0.0;
  each_case(of_objects, picks, judge, [&](const ClassCase& c) {
    if (c.true_class == kVan) return;
    const double weight = 1.0 / (c.lists * number[c.true_class]);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      bins[b].number += weight * c.bins[b].number;
      bins[b].probability_sum += weight * c.bins[b].probability_sum;
      bins[b].so += weight * c.bins[b].so;
      all += weight * c.bins[b].number;
    }
  });
  Calibration result{kNaN, kNaN};
  if (all <= 0.0) return result;
  result = {};
  for (const ClassCase::Bin& bin : bins) {
    if (bin.number <= 0.0) continue;
    const double error = std::abs(bin.probability_sum - bin.so) / bin.number;
    result.mean += error * bin.number / all;
    if (bin.number >= kLeastBinShare * all) result.largest = std::max(result.largest, error);
  }
  return result;
}

}  // namespace

void ClassJudge::add(std::uint32_t track, std::uint32_t object, std::size_t true_class, double age_s,
                     const ReportedClasses& probabilities) {
  if (!(age_s > kLeastAge_s)) return;
  const auto [object_place, is_new_object] = object_of_.try_emplace(object, objects_);
  if (is_new_object) ++objects_;
  const auto [case_place, is_new_case] = case_of_.try_emplace({track, object}, cases_.size());
  if (is_new_case) cases_.push_back({true_class, object_place->second});
  ClassCase& c = cases_[case_place->second];
  c.lists += 1.0;
  c.reported[likeliest(probabilities)] += 1.0;
  c.right += likeliest(probabilities, kVan) == true_class ? 1.0 : 0.0;
  double judged = 0.0;
  for (std::size_t k = 0; k < probabilities.size(); ++k) judged += k == kVan ? 0.0 : probabilities[k];
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    if (k == kVan) continue;
    const double p = judged > 0.0 ? probabilities[k] / judged : 1.0 / static_cast<double>(kJudgedClasses);
    ClassCase::Bin& bin =
        c.bins[std::min(ClassCase::kBins - 1, static_cast<std::size_t>(p * static_cast<double>(ClassCase::kBins)))];
    bin.number += 1.0;
    bin.probability_sum += p;
    bin.so += k == true_class ? 1.0 : 0.0;
  }
}

void ClassJudge::end_drive() {
  case_of_.clear();
  object_of_.clear();
}

void ClassJudge::append(const ClassJudge& other) {
  for (ClassCase c : other.cases_) {
    c.object += objects_;
    cases_.push_back(c);
  }
  objects_ += other.objects_;
}

ClassFigures class_figures(const ClassJudge& judge) {
  const Cases of_objects = by_object(judge);
  std::vector<std::size_t> all(of_objects.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  ClassFigures figures;
  figures.balanced_accuracy = balanced_accuracy(judge, of_objects, all);
  figures.calibration = calibration(judge, of_objects, all);
  figures.accuracy_interval = bootstrap(
      all.size(), [&](const std::vector<std::size_t>& picks) { return balanced_accuracy(judge, of_objects, picks); });
  figures.largest_interval = bootstrap(
      all.size(), [&](const std::vector<std::size_t>& picks) { return calibration(judge, of_objects, picks).largest; });
  for (const ClassCase& c : judge.cases()) {
    ++figures.cases[c.true_class];
    for (std::size_t k = 0; k < kRoadUserClasses; ++k) figures.confusion[c.true_class][k] += c.reported[k] / c.lists;
  }
  for (std::size_t a = 0; a < kRoadUserClasses; ++a) {
    for (double& share : figures.confusion[a]) share /= std::max(1.0, static_cast<double>(figures.cases[a]));
  }
  return figures;
}

}  // namespace boresight::bench::tracking
