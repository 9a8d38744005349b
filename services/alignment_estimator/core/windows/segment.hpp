// Segments of driving time: what each radar saw in some seconds, kept as information about its parameters.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/windows/block.hpp"
#include "services/alignment_estimator/core/windows/columns.hpp"

namespace boresight::alignment::windows {

/// What one radar saw in one segment; see Block.
struct Share {
  Point point;
  LocalVector score = LocalVector::Zero();
  LocalMatrix information = LocalMatrix::Zero();
  double seconds = 0.0;   ///< 0: nothing
  bool positive = false;  ///< its information has been made positive
  double weight = 1.0;    ///< learnt: a segment that contradicts the others counts less
};

/// A fluctuation of yaw, pitch and scale: constant in a segment, with a variance that is learnt.
struct Fluctuation {
  std::array<double, kFluctuations> variance{};
};

/// What a merged segment must know: its parts had fluctuations of their own.
struct MergeNoise {
  Fluctuation common;
  std::array<double, kFluctuations> correlation_s{20.0, 20.0, 20.0};
  std::array<Fluctuation, kMaxRadars> own{};
  double roll_per_pitch = 0.0;  ///< std of a radar's own roll over that of its pitch
};

struct Segment {
  double seconds = 0.0;
  double middle_s = 0.0;  ///< its middle on the clock of the drive
  int level = 0;          ///< of 2^level segments of the shortest length
  int load = 0;           ///< number of load steps before it
};

/// The segments of a drive, oldest first. When there is no room for another, two neighbours of one level become one of
/// the next level: the memory is bounded, and old ones are coarser. No allocation after construction.
class Segments {
 public:
  explicit Segments(std::size_t radars) : shares_(kMaxSegments * radars), radars_(radars) {}

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] Segment& segment(int i) { return segments_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Segment& segment(int i) const { return segments_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Share& share(int i, std::size_t radar) {
    return shares_[static_cast<std::size_t>(i) * radars_ + radar];
  }
  [[nodiscard]] const Share& share(int i, std::size_t radar) const {
    return shares_[static_cast<std::size_t>(i) * radars_ + radar];
  }
  void clear() { size_ = 0; }
  /// Takes away what a radar's shares say about some local parameters: they have changed.
  void forget(std::size_t radar, int first_column, int columns);
  /// Takes away what all radars said about some local parameters in segments that began before this time of the drive.
  void forget_before(double time_s, int first_column, int columns);
  /// A load step at this time of the drive: later segments have it, and one from both sides loses its pitch.
  void add_load(double time_s);
  /// What was seen before the first load step loses its pitch; the others count from there.
  void forget_first_load();
  /// There was no load step of this number.
  void remove_load(int load);
  /// Takes away all that a radar saw in the last seconds.
  void drop_latest(std::size_t radar, double seconds);
  /// Begins a segment after the latest one.
  void begin(int load, const MergeNoise& noise);
  /// Adds a block to the latest segment.
  /// `length_s`: that the segment will have.
  void add(std::size_t radar, const Block& block, double length_s, const MergeNoise& noise);

 private:
  void merge(const MergeNoise& noise);
  void join(int first, const MergeNoise& noise);
  std::array<Segment, kMaxSegments> segments_;
  std::vector<Share> shares_;
  std::size_t radars_;
  int size_ = 0;
};

/// Eliminates local parameters, each known to nothing.
void forget(Share& share, int first_column, int columns);

/// Adds `more` to `sum`: its score is moved to the other's point.
void add_to(Share& sum, const Point& point, const LocalVector& score, const LocalMatrix& information, double seconds);

}  // namespace boresight::alignment::windows
