// Errors of headings beside their stated deviations, by source: pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "services/tracker/core/model/heading.hpp"
#include "tests/benchmarks/common/intervals.hpp"

namespace boresight::bench::tracking {

enum class HeadingSource : std::uint8_t { kFused, kCourse, kOutline, kLine, kInterval };
inline constexpr std::array<std::string_view, 5> kHeadingSources = {"fused", "course", "outline", "line of range rates",
                                                                    "interval search"};

class HeadingJudge {
 public:
  /// A heading of an object of the drive whose true one is `truth_rad`, in the same axes.
  void add(std::uint32_t object, HeadingSource source, const boresight::tracking::Heading& heading, double truth_rad);
  /// Ends a drive: identities of objects begin anew.
  void end_drive() { object_of_.clear(); }
  void append(const HeadingJudge& other);

  struct Figures {
    std::size_t objects = 0;
    double rms_rad = 0.0, nees = 0.0;  ///< over all headings; NaN without any
    Interval rms_interval, nees_interval;
  };
  /// Intervals are of a bootstrap over objects.
  [[nodiscard]] Figures figures(HeadingSource source) const;

 private:
  struct Sums {
    double number = 0.0, squares_rad2 = 0.0, normalised = 0.0;
  };
  using OfObject = std::array<Sums, kHeadingSources.size()>;
  std::vector<OfObject> objects_;
  std::map<std::uint32_t, std::size_t> object_of_;  // of the drive
};

}  // namespace boresight::bench::tracking
