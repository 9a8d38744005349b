// The words of the tables and JSON of a run folder (config/schema/run.md): one list for its writer and its reader.
#pragma once

#include <array>
#include <string_view>

namespace boresight::run {

/// By bit of pipeline_flag.
inline constexpr std::array<std::string_view, 9> kFlagWords = {"no_alignment",     "alignment_stale", "no_ego_motion",
                                                               "ego_motion_stale", "no_elevation",    "no_tracks",
                                                               "tracks_stale",     "scans_dropped",   "distrusted"};
/// By Provenance.
inline constexpr std::array<std::string_view, 7> kOriginWords = {
    "unknown", "moving", "stationary", "ghost_type_1", "ghost_type_2", "clutter", "ambiguity"};
/// By Rejection.
inline constexpr std::array<std::string_view, 4> kRejectionWords = {"", "invalid", "outside_region", "weak"};
/// By bit of alignment_axis.
inline constexpr std::array<std::string_view, 9> kAxisWords = {
    "speed_scale", "yaw", "pitch", "roll", "vehicle_yaw", "vehicle_pitch", "vehicle_roll", "yaw_rate_bias", "slip"};
/// By TrackStatus.
inline constexpr std::array<std::string_view, 2> kStatusWords = {"tentative", "confirmed"};
inline constexpr std::array<std::string_view, 2> kUpdateWords = {"measured", "predicted"};
/// By MovementState.
inline constexpr std::array<std::string_view, 4> kMovementWords = {"unknown", "moving", "stationary", "stopped"};
/// By ObjectClass.
inline constexpr std::array<std::string_view, 6> kClassWords = {"unknown",     "car",        "truck",
                                                                "two_wheeler", "pedestrian", "van"};
/// By bit of track_flag.
inline constexpr std::array<std::string_view, 4> kTrackFlagWords = {"out_of_view", "occluded", "zero_doppler",
                                                                    "merged"};
/// By bit of tracker_flag.
inline constexpr std::array<std::string_view, 3> kTrackerFlagWords = {"work_budget_reached", "capacity_reached",
                                                                      "gates_cut"};
/// By RoadSide.
inline constexpr std::array<std::string_view, 2> kSideWords = {"left", "right"};
/// By PathObjectKind.
inline constexpr std::array<std::string_view, 2> kPathObjectWords = {"obstacle", "track"};
/// By AlignmentState.
inline constexpr std::array<std::string_view, 4> kStateWords = {"no_data", "waiting", "converging", "converged"};

}  // namespace boresight::run
