// How well a tracker's class probabilities hold: pure. A case is a track at an object; its lists share one vote.
//
// Judged are objects of four classes. Vans are not: they differ little from cars. So the probabilities that are judged
// are those of the four classes, given that the object is one of them: p_k / (1 − p_van).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "services/common/extended_object/object_classes.hpp"
#include "tests/benchmarks/common/intervals.hpp"

namespace boresight::bench::tracking {

using ReportedClasses = std::array<double, extended_object::kRoadUserClasses>;

inline constexpr std::array<std::string_view, extended_object::kRoadUserClasses> kClassNames = {
    "pedestrian", "two_wheeler", "car", "van", "truck"};

/// A track at an object of a drive.
struct ClassCase {
  static constexpr std::size_t kBins = 10;  ///< of probability, equally wide
  struct Bin {
    double number = 0.0, probability_sum = 0.0, so = 0.0;
  };
  std::size_t true_class = 0;
  std::uint32_t object = 0;  ///< of all drives: cases of one object are drawn together
  double lists = 0.0;
  std::array<double, extended_object::kRoadUserClasses> reported{};  ///< lists with each class as the likeliest
  double right = 0.0;                                                ///< lists with the right one of the four
  std::array<Bin, kBins> bins{};                                     ///< of the four probabilities
};

class ClassJudge {
 public:
  static constexpr double kLeastAge_s = 1.0;

  /// An entry of a list that is at an object. Those of younger tracks are passed over.
  void add(std::uint32_t track, std::uint32_t object, std::size_t true_class, double age_s,
           const ReportedClasses& probabilities);
  /// Ends a drive: identities of tracks and objects begin anew.
  void end_drive();
  void append(const ClassJudge& other);

  [[nodiscard]] const std::vector<ClassCase>& cases() const { return cases_; }
  [[nodiscard]] std::uint32_t objects() const { return objects_; }

 private:
  std::vector<ClassCase> cases_;
  std::uint32_t objects_ = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> case_of_;  // of the drive, by track and object
  std::map<std::uint32_t, std::uint32_t> object_of_;                        // of the drive
};

struct Calibration {
  double largest = 0.0, mean = 0.0;  ///< |mean probability − share| over bins; NaN without data
};

struct ClassFigures {
  double balanced_accuracy = 0.0;  ///< mean over the four classes; NaN if one has no case
  Interval accuracy_interval;
  Calibration calibration;  ///< each of the four classes with the same weight
  Interval largest_interval;
  std::array<std::array<double, extended_object::kRoadUserClasses>, extended_object::kRoadUserClasses> confusion{};
  std::array<std::size_t, extended_object::kRoadUserClasses> cases{};
};

/// Bins with less than this share of all weight do not count for the largest error.
inline constexpr double kLeastBinShare = 0.02;

/// Intervals are of a bootstrap over objects.
[[nodiscard]] ClassFigures class_figures(const ClassJudge& judge);

}  // namespace boresight::bench::tracking
