// Stationary surroundings of the vehicle: road edges, obstacles on its path, and warnings of collisions.
#pragma once

#include <array>
#include <cstdint>

#include "services/tracker/core/surroundings/collision.hpp"
#include "services/tracker/core/surroundings/path_obstacles.hpp"
#include "services/tracker/core/surroundings/road_edges.hpp"

namespace boresight::tracking {

class Surroundings {
 public:
  /// A scan that is older than `latest_scan_s` or comes after a gap of `longest_gap_s` is a jump of the clock.
  Surroundings(const VehicleConfig& vehicle, const SurroundingsParameters& parameters, double latest_scan_s,
               double longest_gap_s);

  /// Takes one scan at its own time, and the tracks after it. Does not allocate.
  void step(const ClassifiedScan& scan, const TrackList& tracks);
  /// Writes everything behind the tracks.
  void write(TrackList& out) const;

 private:
  /// How long an object has fulfilled the conditions of a warning.
  struct Threat {
    std::uint32_t id = 0;
    PathObjectKind kind = PathObjectKind::kTrack;
    double lasts_s = 0.0;
    bool is_present = false;
  };
  static constexpr std::size_t kMaxThreats = 64;
  static constexpr std::size_t kMaxListed = kMaxTracks + 32;

  void move(const ClassifiedScan& scan);
  void assess(const TrackList& tracks);
  void list(PathObject object, const MeetingObject& meets);
  [[nodiscard]] bool is_threat(const PathObject& object, const Meeting& m) const;
  /// Notes that the object fulfils the conditions; returns for how long it has.
  double note_threat(std::uint32_t id, PathObjectKind kind);

  SurroundingsParameters parameters_;
  double latest_scan_s_, longest_gap_s_;
  StationaryMemory memory_;
  RoadEdges edges_;
  PathObstacles obstacles_;
  EgoPath path_;
  std::array<Threat, kMaxThreats> threats_{};
  std::vector<PathObject> listed_;
  bool has_time_ = false;
  std::int64_t time_ns_ = 0;
  double elapsed_s_ = 0.0;
};

}  // namespace boresight::tracking
