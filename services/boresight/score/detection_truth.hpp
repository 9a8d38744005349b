// The true origin of each detection, scan by scan, read as the time goes on.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/score/table.hpp"

namespace boresight::score {

struct TrueOrigin {
  Provenance provenance = Provenance::kUnknown;  ///< kUnknown: no labelled moving object, nothing else is known
  std::string_view cause;                        ///< "": not given
  std::uint32_t object = 0;                      ///< that reflects, also of its ghosts; 0: none, or not given
};

class DetectionTruth {
 public:
  /// A scan of the run and one of the truth are the same if their times differ by less. Choice: a fifth of the shortest
  /// cycle.
  static constexpr double kSameTime_s = 0.005;
  /// The table is read so far ahead, and scans are kept for so long.
  static constexpr double kAhead_s = 1.0, kBack_s = 2.0;

  /// `is_labels`: columns of labels.csv instead of truth_detections.csv.
  DetectionTruth(const std::filesystem::path& file, bool is_labels);

  /// The origins of the detections of a scan, by index; nullptr if the truth does not contain the scan. The scan is
  /// found by its time. A radar with wrong stamps is found by the number of the scan and of its detections. Valid until
  /// the next call.
  [[nodiscard]] const std::vector<TrueOrigin>* find(std::uint32_t radar, double t_s, std::uint64_t scan,
                                                    std::size_t detections);
  /// Whether the table states the object of each detection.
  [[nodiscard]] bool has_objects() const { return table_.has("object"); }

 private:
  struct TrueScan {
    double t_s;
    std::uint64_t scan;  // 0: not given
    std::vector<TrueOrigin> origins;
  };
  void read_until(double t_s);
  void take_row(double t_s);

  Table table_;
  bool is_labels_;
  bool has_row_ = false;
  std::map<std::uint32_t, std::deque<TrueScan>> scans_;  // by radar
  std::set<std::string, std::less<>> causes_;
};

}  // namespace boresight::score
