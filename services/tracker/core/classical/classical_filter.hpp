// The classical chain of a 4D radar: clusters, gates, one association, a Kalman filter for each track, rules of life.
//
// Each scan is used in these steps, each of which can be explained by itself:
//   1. Tracks are predicted with constant acceleration (core/filters).
//   2. Mature tracks take the detections in their predicted box and range-rate gate: point to box.
//   3. The remaining detections are clustered by DBSCAN.
//   4. Tentative tracks take clusters within gates on centre and range rate, the likeliest pair first.
//   5. Each track with detections is corrected: centre, velocity along and across the lines of sight.
//   6. The existence of each track follows from its one association (Musicki, Evans and Stankovic 1994), with the
//      likelihood ratio of its detections to the learnt clutter.
//   7. A cluster that no track takes starts a track; m hits in n looks make it mature, k misses in t looks end it.
// What a radar shows of an object (probability of detection, clutter, boxes by class, side lobes) is the model that all
// trackers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/tracker/core/classical/clusters.hpp"
#include "services/tracker/core/classical/heading/heading.hpp"
#include "services/tracker/core/classical/looks.hpp"
#include "services/tracker/core/classical/parameters.hpp"
#include "services/tracker/core/filter.hpp"
#include "services/tracker/core/filters/motion_filter.hpp"

namespace boresight::tracking::classical {

/// Headings of one track after a scan, each by its own source; empty where it has none.
struct HeadingSources {
  std::uint32_t id = 0;
  std::optional<Heading> course, line, interval, shape;
};

class ClassicalFilter final : public Filter {
 public:
  ClassicalFilter(const Parameters& parameters, std::size_t max_objects, std::size_t max_detections);

  void step(Model& model, double elapsed_s) override;
  void clear() override;
  [[nodiscard]] std::span<const ObjectEstimate> estimates() const override { return estimates_; }
  [[nodiscard]] std::span<const double> explained() const override { return explained_; }
  [[nodiscard]] const FilterWork& work() const override { return work_; }
  /// Of the mature tracks that the scan detected, in local axes; for reports.
  [[nodiscard]] std::span<const HeadingSources> headings() const { return headings_; }

 private:
  struct Track {
    explicit Track(const filters::MotionFilter& begun) : motion(begun) {}
    filters::MotionFilter motion;
    std::uint32_t id = 0;
    /// What the shared model knows of the object. Place and velocity are those of `motion`.
    Component<double> component;
    double existence = 0.0;  ///< probability of an object or a source of clutter that lasts
    double since_detection_s = 0.0;
    Looks looks;
    bool is_mature = false;
    History history;
    double unseen_s = 0.0;  ///< between the latest detections and those before
    // Of the scan.
    Cell<double> cell;
    std::optional<Heading> shape_heading;
  };
  static constexpr std::int32_t kFree = -1;

  void predict(const Model& model, double elapsed_s);
  void look(const Model& model);
  void associate_mature(const Model& model);
  void associate_tentative(const Model& model);
  void update(const Model& model);
  void update_detected(Track& track, Prediction<double>& prediction, const View<double>& view, const Model& model);
  void find_heading(const Model& model, std::size_t track);
  void start(Model& model);
  void end_tracks(const Model& model);
  void join_parts(Model& model);
  void report();
  void take(std::size_t track, std::size_t cluster);
  [[nodiscard]] filters::ProcessNoise noise_of(const Model& model, const Track& track) const;
  /// Value of the likeliest class.
  template <typename Value>
  [[nodiscard]] static Value of_class(const ByClass<Value>& values, std::span<const double> probabilities);

  Parameters parameters_;
  std::size_t max_objects_;
  std::vector<Track> tracks_;
  std::vector<View<double>> views_;              // of the tracks
  std::vector<Prediction<double>> predictions_;  // of the tracks
  std::vector<double> existence_;                // of the tracks, as objects
  std::vector<std::int32_t> taken_by_;           // by detection: index of a track
  Clusters clusters_;
  std::size_t number_of_clusters_ = 0;
  std::vector<char> is_used_;  // by cluster
  struct Pair {
    double log_likelihood;
    std::size_t track, cluster;
  };
  std::vector<Pair> pairs_;
  std::vector<Measurement<double>> members_;  // of a cluster
  std::vector<HeadingSources> headings_;
  std::vector<ObjectEstimate> estimates_;
  std::vector<double> explained_;
  FilterWork work_;
  std::uint32_t next_id_ = 1;
};

}  // namespace boresight::tracking::classical
