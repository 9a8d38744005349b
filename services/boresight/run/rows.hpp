// Results of the chain as rows of the tables of a run folder: config/schema/run.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "services/boresight/run/results.hpp"

namespace boresight::run {

/// Header lines without line feed.
inline constexpr std::string_view kScansHeader =
    "t_s,time_ns,radar,scan,detections,flags,sensor_x_m,sensor_y_m,sensor_vx_mps,sensor_vy_mps,ego_speed_mps,"
    "ego_yaw_rate_radps,moving,tracks,confirmed,tracker_flags,likelihood_evaluations";
inline constexpr std::string_view kDetectionsHeader =
    "t_s,time_ns,radar,scan,index,range_m,azimuth_rad,elevation_rad,range_rate_mps,rcs_dbsm,x_vehicle_m,y_vehicle_m,"
    "z_vehicle_m,range_rate_over_ground_mps,origin,p_moving,p_stationary,p_ghost_type_1,p_ghost_type_2,p_clutter,"
    "p_ambiguity,rejected";
inline constexpr std::string_view kReflectorsHeader =
    "t_s,time_ns,radar,scan,index,x1_vehicle_m,y1_vehicle_m,x2_vehicle_m,y2_vehicle_m,residual_std_m,detections";
inline constexpr std::string_view kTracksHeader =
    "t_s,time_ns,radar,scan,id,status,update,movement,class,existence,mirror_probability,p_unknown,p_car,p_truck,"
    "p_two_wheeler,p_pedestrian,p_van,flags,age_s,since_update_s,x_vehicle_m,y_vehicle_m,z_vehicle_m,"
    "vx_over_ground_mps,vy_over_ground_mps,heading_rad,length_m,width_m,height_m,heading_std_rad,length_std_m,"
    "width_std_m,detections,cov_x_x,cov_x_y,cov_x_vx,cov_x_vy,cov_y_y,cov_y_vx,cov_y_vy,cov_vx_vx,cov_vx_vy,cov_vy_vy";
inline constexpr std::string_view kRoadEdgesHeader =
    "t_s,time_ns,radar,scan,id,side,update,existence,age_s,since_update_s,start_x_m,end_x_m,c0_m,c1,c2_per_m,"
    "scatter_std_m,detections,cov_0_0,cov_0_1,cov_0_2,cov_1_1,cov_1_2,cov_2_2";
inline constexpr std::string_view kCollisionWarningsHeader =
    "t_s,time_ns,radar,scan,kind,id,warning,update,age_s,existence,collision_probability,time_to_collision_s,"
    "time_to_collision_std_s,required_deceleration_mps2,path_offset_m,path_offset_std_m,length_m,width_m,x_vehicle_m,"
    "y_vehicle_m,vx_over_ground_mps,vy_over_ground_mps,cov_x_x,cov_x_y,cov_y_y";
inline constexpr std::string_view kAlignmentHeader =
    "t_s,time_ns,radar,state,speed_scale,yaw_rad,pitch_rad,roll_rad,rotation_x_rad,rotation_y_rad,rotation_z_rad,"
    "cov_k_k,cov_k_x,cov_k_y,cov_k_z,cov_x_x,cov_x_y,cov_x_z,cov_y_y,cov_y_z,cov_z_z,observable,inlier_ratio,"
    "step_changes,load_pitch_rad,load_pitch_std_rad,range_rate_scale,range_rate_scale_std,reason,finding";

/// Names of pipeline_flag bits, joined by '+'; "" if none is set.
[[nodiscard]] std::string names_of_flags(std::uint32_t pipeline_flags);
[[nodiscard]] std::string_view name_of_flag(std::size_t bit);
/// Names of alignment_axis bits, joined by '+'.
[[nodiscard]] std::string names_of_axes(std::uint32_t axes);

/// Each appends complete rows.
void append_scan(std::string& rows, const ScanResult& result);
void append_detections(std::string& rows, const ScanResult& result);
void append_reflectors(std::string& rows, const ScanResult& result);
void append_tracks(std::string& rows, const ScanResult& result);
void append_road_edges(std::string& rows, const ScanResult& result);
void append_collision_warnings(std::string& rows, const ScanResult& result);
void append_estimate(std::string& rows, const EstimateResult& result);

}  // namespace boresight::run
