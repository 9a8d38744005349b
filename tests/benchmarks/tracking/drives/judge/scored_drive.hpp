// A drive of one tracker, reduced to what a judgement at any threshold needs. Objects, distances and false tracks are
// those of judge::TrackJudge (config/schema/truth.md); only tracks that count differ with the threshold.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "tests/benchmarks/tracking/drives/judge/scene.hpp"

namespace boresight::bench::tracking {

/// Errors of an assigned track.
struct TrackErrors {
  float along_m = 0.0F, across_m = 0.0F;  ///< of the position, in the axes of the true box
  float length_m = 0.0F;
  float heading_rad = 0.0F;             ///< −π … π
  float mahalanobis_squared = 0.0F;     ///< of the position, by the stated covariance; NaN without one
  bool is_near = false, moves = false;  ///< of the object: within kNear_m; faster than a parked one
};

/// Bins of existence, each 0.1 wide.
struct Reliability {
  static constexpr std::size_t kBins = 10;
  struct Bin {
    std::uint64_t entries = 0, at_an_object = 0;
    double score_sum = 0.0;
  };
  std::array<Bin, kBins> bins{};

  /// Scores outside 0…1 are not counted.
  void add(double score, bool is_at_an_object);
  Reliability& operator+=(const Reliability& other);
};

class ScoredDrive {
 public:
  static constexpr double kNear_m = 50.0;  ///< bound of the bars of size and heading

  /// A true object that is not parked.
  struct Object {
    std::uint32_t id = 0;
    ObjectClass object_class = ObjectClass::kUnknown;
    std::uint32_t lists_in_view = 0;  ///< in view and within the judged range
    double in_view_s = 0.0, last_s = -1.0;
  };
  /// An entry of a list that is at an object.
  struct NearTrack {
    float score;
    bool confirmed, in_range, stands;
  };
  /// A possible assignment.
  struct Pair {
    std::uint32_t object;  ///< index in objects()
    std::uint16_t track;   ///< index in the list's tracks
    bool is_scored;        ///< the object is in view and within the judged range
    TrackErrors errors;
  };
  struct List {
    std::vector<NearTrack> tracks;
    std::vector<Pair> pairs;  ///< in the order of assignment, nearest first
  };
  /// An entry within the judged range that is at no object.
  struct FalseTrack {
    float score;
    bool confirmed;
  };

  void add(const Scene& scene);

  [[nodiscard]] const std::vector<Object>& objects() const { return objects_; }
  [[nodiscard]] const std::vector<List>& lists() const { return lists_; }
  [[nodiscard]] const std::vector<FalseTrack>& false_tracks() const { return false_tracks_; }
  [[nodiscard]] const Reliability& reliability() const { return reliability_; }
  /// Confirmed tracks that are at no object for most of their life of judge::TrackJudge::kLongFalseLife_s or more.
  [[nodiscard]] std::size_t long_false_tracks() const;

 private:
  /// Of a track, in lists where it is confirmed and within the judged range.
  struct Life {
    double first_s = 0.0, last_s = 0.0;
    std::uint32_t lists = 0, lists_at_none = 0;
  };
  void live(const ListedTrack& track, double t_s, bool is_at_an_object);
  [[nodiscard]] std::uint32_t index_of(const judge::TrueObject& object);
  void see(const judge::TrueObject& object, double t_s);

  std::vector<Object> objects_;
  std::map<std::uint32_t, std::uint32_t> index_of_id_;
  std::vector<List> lists_;
  std::vector<FalseTrack> false_tracks_;
  Reliability reliability_;
  std::map<std::uint32_t, Life> lives_;  // by track
};

}  // namespace boresight::bench::tracking
