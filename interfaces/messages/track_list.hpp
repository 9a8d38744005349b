// The objects around the vehicle: one list per processed scan.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

enum class TrackStatus : std::uint8_t { kTentative = 0, kConfirmed = 1 };
/// Whether the latest scan with the object in its field of view detected it.
enum class TrackUpdate : std::uint8_t { kMeasured = 0, kPredicted = 1 };
enum class MovementState : std::uint8_t { kUnknown = 0, kMoving = 1, kStationary = 2, kStopped = 3 };
enum class ObjectClass : std::uint8_t { kUnknown = 0, kCar = 1, kTruck = 2, kTwoWheeler = 3, kPedestrian = 4 };

/// State order of `Track::covariance`.
inline constexpr std::size_t kTrackStateSize = 6;

/// One object. Positions in the vehicle frame at the list's measurement time; velocity and acceleration over ground,
/// expressed in vehicle axes.
struct Track {
  std::uint32_t tracking_id;  ///< never reused while the tracker runs; 0 is no track
  TrackStatus status;
  TrackUpdate update;
  MovementState movement;
  ObjectClass object_class;
  float age_s;
  float time_since_update_s;
  float existence_probability;  ///< 0…1
  float heading_rad;            ///< direction of the length axis in the vehicle frame
  float length_m;               ///< full extents of the object's box
  float width_m;
  float height_m;  ///< 0 if no radar measured elevation
  std::array<float, 3> position_vehicle_m;
  std::array<float, 2> velocity_over_ground_mps;
  std::array<float, 2> acceleration_over_ground_mps2;
  std::uint32_t number_of_detections;  ///< associated in this scan
  std::array<std::uint32_t, 3> reserved;
  /// Row-major 6 × 6 over (x, y, v_x, v_y, a_x, a_y).
  alignas(16) std::array<float, kTrackStateSize * kTrackStateSize> covariance;
};
static_assert(sizeof(Track) == 224);

inline constexpr std::size_t kMaxTracks = 128;

/// All tracks after the scan `header.source_id` / `header.source_sequence`; entries 0…number_of_tracks−1 are valid.
struct TrackList {
  static constexpr std::uint32_t kVersion = 1;

  MessageHeader header;
  std::uint32_t number_of_tracks;
  std::uint32_t number_of_confirmed_tracks;
  std::uint32_t flags;           ///< pipeline_flag bits of the scan
  std::uint32_t dropped_tracks;  ///< objects beyond kMaxTracks
  std::uint64_t reserved;
  alignas(64) std::array<Track, kMaxTracks> tracks;
};

static_assert(kIsPlainMessage<TrackList>);
static_assert(offsetof(TrackList, tracks) == 128);
static_assert(sizeof(TrackList) == 128 + kMaxTracks * 224);

}  // namespace boresight
