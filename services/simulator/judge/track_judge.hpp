// Quality of confirmed tracks over a drive, by class and range of the true objects.
//
// Every definition is stated here and in config/schema/truth.md. Only confirmed tracks are judged, and each track list
// counts the same.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "services/simulator/judge/figure_list.hpp"
#include "services/simulator/judge/gospa.hpp"
#include "services/simulator/judge/matching.hpp"
#include "services/simulator/judge/pairing.hpp"
#include "services/simulator/judge/scored_scene.hpp"

namespace boresight::judge {

class TrackJudge {
 public:
  // All of these are choices.
  /// An object that is out of view for longer begins a new stay when it returns.
  static constexpr double kLongestGapInView_s = 1.0;
  /// Objects and stays that are in view for less time are too short to be found.
  static constexpr double kShortestView_s = 1.0;
  /// Lives of false tracks that are counted separately.
  static constexpr double kShortFalseLife_s = 0.5, kLongFalseLife_s = 2.0;
  /// A track that is missing from the lists for longer has ended.
  static constexpr double kTrackForgotten_s = 10.0;
  /// 95 % of a Gaussian position lie within this squared Mahalanobis distance (χ², two degrees of freedom).
  static constexpr double kChiSquared95 = 5.991464547;

  /// One track list with the objects at its time.
  void add(double t_s, std::span<const ScoredTrack> tracks, std::span<const TrueObject> objects);
  /// Ends the stays of the objects and the lives of the tracks; called once, after the last list.
  void finish();
  /// Names "tracks.…".
  void write(FigureList& figures) const;

  [[nodiscard]] std::uint64_t lists() const { return lists_; }

 private:
  /// Sums of a class in a range band.
  struct Cell {
    std::uint64_t objects = 0, objects_found = 0;
    std::uint64_t stays = 0, stays_found = 0;
    std::vector<double> delays_s;  // of the stays found
    std::uint64_t lists_in_view = 0, lists_tracked = 0;
    double along_m2 = 0.0, across_m2 = 0.0, speed_m2ps2 = 0.0, heading_rad2 = 0.0, length_m2 = 0.0, width_m2 = 0.0;
    std::uint64_t switches = 0, fragments = 0;
    std::uint64_t errors_inside = 0, errors_with_covariance = 0;
    Cell& operator+=(const Cell& other);
  };
  /// What is known of an object. A stay is an interval in view.
  struct ObjectRecord {
    ObjectClass object_class = ObjectClass::kUnknown;
    std::array<double, kBands + 1> in_view_s{};
    std::array<bool, kBands + 1> found{};
    double since_s = 0.0, last_s = 0.0, found_s = -1.0;  // of the stay; found: −1 is never
    bool stays = false, is_tracked = false;
    std::size_t first_band = 0;
    std::uint32_t track = 0;  // the latest one in this stay
  };
  struct Life {
    double first_s = 0.0, last_s = 0.0;
    std::uint64_t lists = 0, lists_at_none = 0;
    double range_sum_m = 0.0;
  };
  struct FalseCounts {
    std::uint64_t tracks = 0, short_lives = 0, long_lives = 0;  // all; at least 0.5 s; at least 2 s
    std::uint64_t lists = 0;
  };

  [[nodiscard]] static bool is_scored(const TrueObject& object);
  [[nodiscard]] bool is_at_an_object(const ScoredTrack& track, std::span<const TrueObject> objects) const;
  void pair_up(std::span<const TrueObject> objects);
  void judge_lives(double t_s, std::span<const TrueObject> objects);
  void judge_object(double t_s, const TrueObject& object, const ScoredTrack* track);
  void judge_errors(const TrueObject& object, const ScoredTrack& track, std::size_t band);
  void judge_gospa(std::span<const TrueObject> objects);
  void end_stay(ObjectRecord& record);
  void end_life(const Life& life);
  template <typename Change>
  void change_cells(ObjectClass object_class, std::size_t band, const Change& change) {
    change(cells_[index_of(object_class)][band]);
    change(cells_[index_of(object_class)][kAllBands]);
  }

  std::array<std::array<Cell, kBands + 1>, kClasses> cells_{};
  std::map<std::uint32_t, ObjectRecord> records_;    // by object
  std::map<std::uint32_t, Life> lives_;              // by track
  std::map<std::uint32_t, std::uint32_t> track_of_;  // by object, in the previous list
  std::array<FalseCounts, kBands + 1> false_{};
  std::uint64_t lists_ = 0, duplicates_ = 0;
  double next_sweep_s_ = 0.0;
  GospaParts gospa_squared_, gospa_root_;

  // Of the present list.
  std::vector<ScoredTrack> confirmed_;
  std::vector<PairCost> pairs_;
  Pairing pairing_;  // of the tracks that keep no object
  std::vector<std::size_t> object_of_track_, track_of_object_;
  std::vector<std::size_t> free_tracks_, free_objects_;
  Gospa gospa_;
  std::vector<Ellipse> object_ellipses_, track_ellipses_;
};

}  // namespace boresight::judge
