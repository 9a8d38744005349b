// Boxes of the tracked objects by their labels. All hypotheses of an object share one: its class and size are no part
// of the association.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/model/box_estimator.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/model/road.hpp"

namespace boresight::tracking {

/// Where an object's detections lie in a scan, by what it may be; local axes.
struct BoxReadings {
  std::size_t number = 0;  ///< 0: its heading is not known
  std::array<Reading<double>, View<double>::kMaxReadings> readings{};
  double share_in_view = 0.0;              ///< of its reflections
  double range_rate_variance_m2ps2 = 0.0;  ///< without the sensor's noise
};

class ObjectBoxes {
 public:
  struct Record {
    std::uint32_t label = 0;
    BoxMemory memory;
    // In the scan, computed for the first hypothesis that is asked for.
    bool is_seen = false;
    Vector2<double> predicted_m;
    Symmetric2<double> predicted_covariance_m2, noise_m2;
    ClassViews views;
    std::optional<BoxReadings> readings;
  };

  ObjectBoxes(const BoxEstimator& estimator, const RoadParameters& road, std::size_t max_objects);

  void clear();
  /// Notes that the object `whole` has a part; what is remembered of it is that of `label` from now on.
  void join(const Component<double>& whole, const Component<double>& part, std::uint32_t label);
  void begin_scan(const Viewpoint& viewpoint);
  [[nodiscard]] const Record* find(std::uint32_t label) const;
  /// The record of a predicted object with its views; null if nothing is remembered of it.
  [[nodiscard]] Record* see(const Component<double>& predicted, const Symmetric2<double>& noise_m2);
  /// Takes the objects after a scan that came `elapsed_s` after the one before; others are forgotten.
  void learn(std::span<const ObjectEstimate> objects, double elapsed_s, double road_heading_rad);
  [[nodiscard]] Box box(const Component<double>& object) const;
  [[nodiscard]] const BoxEstimator& estimator() const { return estimator_; }

 private:
  [[nodiscard]] std::size_t begin_record(std::uint32_t label);

  BoxEstimator estimator_;
  ParallelTraffic traffic_;
  Viewpoint viewpoint_;
  std::size_t max_objects_;
  std::vector<Record> records_;           // for twice the objects: those of a scan and of the one before
  std::vector<std::size_t> used_, free_;  // of records_
  std::vector<char> is_kept_;             // of records_
  FixedTable index_;                      // of records_ by label
};

}  // namespace boresight::tracking
