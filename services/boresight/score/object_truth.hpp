// The true objects at any time of a drive, read as the time goes on: memory for the objects of a few seconds.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "services/boresight/score/table.hpp"
#include "services/simulator/judge/scored_scene.hpp"

namespace boresight::score {

/// Which objects a radar has seen lately, by truth_visibility.csv.
class Visibility {
 public:
  explicit Visibility(const std::filesystem::path& file);
  /// Whether any radar had a free line of sight to the object at most judge::kHidden_s before. Times may go back by
  /// less than that.
  [[nodiscard]] bool sees(std::uint32_t object, double t_s);

 private:
  void read_until(double t_s);
  Table table_;
  bool has_row_ = false;
  double row_s_ = 0.0;
  std::map<std::uint32_t, double> last_seen_s_;
};

class ObjectTruth {
 public:
  /// Rows of a table further apart are not interpolated. Choice: boxes by hand come twice a second.
  static constexpr double kLongestGap_s = 1.0;
  /// Before the first and after the last row the truth holds for as long: a period of truth_objects.csv.
  static constexpr double kHold_s = 0.1;
  /// Boxes without the column `parked` are parked if they are slower. Choice: below a pedestrian's pace.
  static constexpr double kSlowestMoving_mps = 0.5;

  /// `is_boxes`: columns of boxes.csv instead of truth_objects.csv. `visibility`: empty if absent.
  ObjectTruth(const std::filesystem::path& file, bool is_boxes, const std::filesystem::path& visibility);

  /// The objects at a time, interpolated between rows of the same object. False if the table does not cover the time.
  /// Times may go back by kBack_s.
  static constexpr double kBack_s = 2.0;
  [[nodiscard]] bool at(double t_s, std::vector<judge::TrueObject>& objects);

  [[nodiscard]] double first_s() const { return first_s_; }  ///< NaN for an empty table
  [[nodiscard]] double last_s() const { return last_s_; }    ///< of the rows read so far

 private:
  struct Instant {
    double t_s;
    std::vector<judge::TrueObject> objects;
  };
  /// The object of the present row.
  [[nodiscard]] judge::TrueObject object() const;
  void read_until(double t_s);

  Table table_;
  bool is_boxes_;
  bool has_row_ = false, ended_ = false;
  std::deque<Instant> instants_;  // the last one may be incomplete unless the table ended
  double first_s_, last_s_;
  std::optional<Visibility> visibility_;
};

}  // namespace boresight::score
