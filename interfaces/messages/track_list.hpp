// The objects around the vehicle: one list per processed scan.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

enum class TrackStatus : std::uint8_t { kTentative = 0, kConfirmed = 1 };
/// Whether the scan of this list detected the object, whichever radar's it is. `Track::flags` tell why it may not have.
enum class TrackUpdate : std::uint8_t { kMeasured = 0, kPredicted = 1 };
enum class MovementState : std::uint8_t { kUnknown = 0, kMoving = 1, kStationary = 2, kStopped = 3 };
enum class ObjectClass : std::uint8_t {
  kUnknown = 0,
  kCar = 1,
  kTruck = 2,
  kTwoWheeler = 3,
  kPedestrian = 4,
  kVan = 5,
};
inline constexpr std::size_t kNumberOfObjectClasses = 6;

/// Rows of `Track::covariance`: x, y, v_x, v_y, heading, length, width.
inline constexpr std::size_t kTrackStateSize = 7;

/// Bits of `Track::flags`: why the object may be undetected, or has no detections of its own.
///
/// They describe the latest scan of each radar that delivered lately. A radar detects an object if it has the object in
/// view, no other object hides it, it moves along the line of sight, and its detections are its own. The first of these
/// that fails is that radar's reason. The flag is the reason of the radar that comes farthest in this order: at most
/// one bit is set, and none if a radar should detect the object. A track that is predicted for long and has no flag is
/// missed for a reason that the tracker does not know.
namespace track_flag {
inline constexpr std::uint32_t kOutOfView = 1u << 0;  ///< no radar that delivered lately has the object in view
inline constexpr std::uint32_t kOccluded = 1u << 1;   ///< other objects hide it from all that have it in view
inline constexpr std::uint32_t kZeroDoppler = 1u
                                              << 2;  ///< too slow along these lines of sight to be detected as moving
/// Another object has a part of its detections, by their probabilities; or it has none, and those in its gate are
/// another object's.
inline constexpr std::uint32_t kMerged = 1u << 3;
}  // namespace track_flag

/// Bits of `TrackList::tracker_flags`: limits that the tracker reached in this step.
namespace tracker_flag {
inline constexpr std::uint32_t kWorkBudgetReached = 1u << 0;  ///< the search for associations was ended early
inline constexpr std::uint32_t kCapacityReached = 1u << 1;    ///< detections, hypotheses or objects were dropped
/// Nothing was dropped, but objects that share detections were associated apart: there were more than a group holds.
inline constexpr std::uint32_t kGatesCut = 1u << 2;
}  // namespace tracker_flag

/// One object. Positions in the vehicle frame at the list's measurement time; velocity over ground, expressed in
/// vehicle axes.
struct Track {
  std::uint32_t tracking_id;  ///< never reused while the tracker runs; 0 is no track
  TrackStatus status;
  TrackUpdate update;
  MovementState movement;
  ObjectClass object_class;  ///< the likeliest one of `class_probability`
  float age_s;
  float time_since_update_s;
  float existence_probability;  ///< 0…1
  float mirror_probability;  ///< 0…1: that the track is a mirror image of another object, by its detections' origins
  float heading_rad;         ///< direction of the length axis in the vehicle frame
  float length_m;            ///< full extents of the object's box
  float width_m;
  float height_m;                           ///< 0 if no radar measured elevation
  std::array<float, 3> position_vehicle_m;  ///< centre of the box
  std::array<float, 2> velocity_over_ground_mps;
  std::uint32_t number_of_detections;                           ///< associated in this scan
  std::uint32_t flags;                                          ///< track_flag bits
  std::array<float, kNumberOfObjectClasses> class_probability;  ///< by ObjectClass, 0…1; they sum to 1
  /// Row-major 7 × 7 over (x, y, v_x, v_y, heading, length, width); m, m/s, rad.
  std::array<float, kTrackStateSize * kTrackStateSize> covariance;
};
static_assert(sizeof(Track) == 288);
static_assert(offsetof(Track, class_probability) == 68);
static_assert(offsetof(Track, covariance) == 92);

inline constexpr std::size_t kMaxTracks = 128;

enum class RoadSide : std::uint8_t { kLeft = 0, kRight = 1 };

/// Coefficients of a road edge: c0 in m, c1 in 1, c2 in 1/m.
inline constexpr std::size_t kRoadEdgeStateSize = 3;

/// An edge of the road: the line along which stationary detections concentrate beside the vehicle's path (rail, kerb,
/// wall, facade, row of parked cars). y(x) = c0 + c1 x + c2 x²/2 in the vehicle frame at the list's measurement time.
struct RoadEdge {
  std::uint32_t edge_id;  ///< never reused while the tracker runs; 0 is no edge
  RoadSide side;
  TrackUpdate update;  ///< whether detections of this scan lie on it
  std::array<std::uint8_t, 2> reserved;
  float age_s;
  float time_since_update_s;
  float existence_probability;  ///< 0…1
  float start_x_m;              ///< the part that was detected lately; beyond it the line is extrapolated
  float end_x_m;
  float scatter_std_m;  ///< of its detections across the line, without the radars' noise
  std::array<float, kRoadEdgeStateSize> coefficients;
  std::array<float, kRoadEdgeStateSize * kRoadEdgeStateSize> covariance;  ///< row-major, of the coefficients
  std::uint32_t number_of_detections;                                     ///< on the line in this scan
};
static_assert(sizeof(RoadEdge) == 84);

/// Two for each side.
inline constexpr std::size_t kMaxRoadEdges = 4;

enum class PathObjectKind : std::uint8_t {
  kStationaryObstacle = 0,  ///< stationary detections; `object_id` counts obstacles
  kTrack = 1,               ///< an object of `tracks`; `object_id` is its tracking_id
};

/// Something that the vehicle may drive into. The vehicle's path is the circle of its speed and yaw rate, uncertain by
/// both and by what the driver does until then. The vehicle's outline is configured.
struct PathObject {
  std::uint32_t object_id;  ///< 0 is no object
  PathObjectKind kind;
  TrackUpdate update;
  std::uint8_t warning;  ///< 1: a collision threatens; 0: not
  std::uint8_t reserved;
  float age_s;
  float existence_probability;  ///< 0…1
  /// 0…1: that the vehicle's outline meets the object, if neither driver acts; with the object's existence.
  float collision_probability;
  float
      time_to_collision_s;  ///< from the outline's front to the object's nearest face; +infinity: they do not approach
  float time_to_collision_std_s;
  float required_deceleration_mps2;  ///< constant one with which the vehicle would just not reach the object
  float path_offset_m;               ///< of the object's centre from the vehicle's path at that time, + left
  float path_offset_std_m;
  float length_m;  ///< extents along and across the vehicle's path
  float width_m;
  std::array<float, 2> position_vehicle_m;        ///< of its centre now
  std::array<float, 2> velocity_over_ground_mps;  ///< in vehicle axes
  std::array<float, 3> position_covariance_m2;    ///< xx, xy, yy
};
static_assert(sizeof(PathObject) == 76);

inline constexpr std::size_t kMaxPathObjects = 16;

/// All tracks after the scan `header.source_id` / `header.source_sequence`; entries 0…number_of_tracks−1 are valid,
/// confirmed ones first. Every track above the tracker's reporting limit is in the list with its existence, tentative
/// ones too. From which existence on a track counts is the reader's choice; `status` is the default choice.
struct TrackList {
  static constexpr std::uint32_t kVersion = 3;

  MessageHeader header;
  std::uint32_t number_of_tracks;
  std::uint32_t number_of_confirmed_tracks;
  std::uint32_t flags;                   ///< pipeline_flag bits of the scan
  std::uint32_t dropped_tracks;          ///< objects beyond kMaxTracks
  std::uint32_t tracker_flags;           ///< tracker_flag bits
  std::uint32_t likelihood_evaluations;  ///< work of the step; the same input gives the same number
  alignas(64) std::array<Track, kMaxTracks> tracks;
  std::uint32_t number_of_road_edges;    ///< valid entries of `road_edges`: nearest to the path first
  std::uint32_t number_of_path_objects;  ///< valid entries of `path_objects`: warnings first, then the likeliest
  std::uint32_t number_of_collision_warnings;
  std::uint32_t dropped_path_objects;  ///< beyond kMaxPathObjects
  std::array<RoadEdge, kMaxRoadEdges> road_edges;
  std::array<PathObject, kMaxPathObjects> path_objects;
};

static_assert(kIsPlainMessage<TrackList>);
static_assert(offsetof(TrackList, tracks) == 128);
static_assert(offsetof(TrackList, number_of_road_edges) == 128 + kMaxTracks * sizeof(Track));
static_assert(offsetof(TrackList, path_objects) ==
              128 + kMaxTracks * sizeof(Track) + 16 + kMaxRoadEdges * sizeof(RoadEdge));
static_assert(sizeof(TrackList) % 64 == 0);

}  // namespace boresight
