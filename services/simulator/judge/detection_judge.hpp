// Quality of the classification of detections over a drive.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/simulator/judge/confusion.hpp"
#include "services/simulator/judge/figure_list.hpp"
#include "services/simulator/judge/reliability.hpp"

namespace boresight::judge {

/// One detection with its true origin. kUnknown as truth: the truth says only that it is no labelled moving object.
struct JudgedDetection {
  Provenance truth = Provenance::kUnknown;
  std::string_view cause;  ///< of a false detection: "side_lobe"; empty or "none": not given
  Provenance label = Provenance::kUnknown;
  bool rejected = false;
  double p_moving = kNaN;  ///< probability of a direct echo of a moving object; NaN: not given
};

class DetectionJudge {
 public:
  void add_scan(std::span<const JudgedDetection> detections);
  /// Names "detections.…".
  void write(FigureList& figures) const;
  [[nodiscard]] std::uint64_t scans() const { return scans_; }

 private:
  /// Detections of a cause.
  struct CauseCount {
    std::uint64_t all = 0, moving = 0;  // not rejected; of these classified as moving
  };
  std::uint64_t scans_ = 0;
  Confusion confusion_;
  std::map<std::string, CauseCount, std::less<>> causes_;
  std::vector<std::uint64_t> scans_by_false_moving_;  // [n]: scans with n false moving detections
  Reliability reliability_;
  std::uint64_t moving_with_probability_ = 0;
};

}  // namespace boresight::judge
