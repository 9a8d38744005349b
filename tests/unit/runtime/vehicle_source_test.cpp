// What two radars of a vehicle cannot share.
#include "services/common/runtime/config/vehicle_source.hpp"

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"

namespace boresight::config {
namespace {

MountingPose pose(double x_m, double yaw_deg, double pitch_deg, double roll_deg) {
  return {{x_m, 0.5, 0.6}, yaw_deg * kRadiansPerDegree, pitch_deg * kRadiansPerDegree, roll_deg * kRadiansPerDegree};
}

TEST(SamePose, IsOneWithinACentimetreAndADegree) {
  const MountingPose front = pose(3.6, 45.0, 1.0, 0.0);
  EXPECT_TRUE(is_same_pose(front, front));
  EXPECT_TRUE(is_same_pose(front, pose(3.609, 45.9, 1.0, 0.0)));
  EXPECT_FALSE(is_same_pose(front, pose(3.611, 45.0, 1.0, 0.0)));
  EXPECT_FALSE(is_same_pose(front, pose(3.6, 46.1, 1.0, 0.0)));
  EXPECT_FALSE(is_same_pose(front, pose(3.6, 45.0, 2.1, 0.0)));
  EXPECT_FALSE(is_same_pose(front, pose(3.6, 45.0, 1.0, 180.0))) << "one of two is upside down";
}

TEST(SamePose, DoesNotDependOnHowADirectionIsWritten) {
  EXPECT_TRUE(is_same_pose(pose(-0.9, 180.0, 0.0, 0.0), pose(-0.9, -180.0, 0.0, 0.0)));
  EXPECT_TRUE(is_same_pose(pose(-0.9, 179.8, 0.0, 0.0), pose(-0.9, -179.8, 0.0, 0.0)));
  EXPECT_TRUE(is_same_pose(pose(2.0, 10.0, 90.0, 0.0), pose(2.0, 0.0, 90.0, 10.0))) << "straight up";
}

RadarConfig udp(const char* address, const char* sender) {
  RadarConfig radar;
  radar.source = {.link = LinkKind::kUdp, .interface = "", .address = address, .port = 42102, .sender = sender};
  return radar;
}

TEST(SameSource, OfUdpIsAddressPortAndSender) {
  const RadarConfig radar = udp("224.0.2.2", "10.13.1.113");
  EXPECT_TRUE(is_same_source(radar, radar));
  EXPECT_TRUE(is_same_source(radar, udp("224.0.2.2", ""))) << "any sender is this one, too";
  EXPECT_TRUE(is_same_source(radar, udp("224.0.2.2", "::ffff:10.13.1.113"))) << "another way to write it";
  EXPECT_FALSE(is_same_source(radar, udp("224.0.2.2", "10.13.1.114")));
  EXPECT_FALSE(is_same_source(radar, udp("224.0.2.3", "10.13.1.113")));
  RadarConfig other = radar;
  other.source.port = 42103;
  EXPECT_FALSE(is_same_source(radar, other));
}

TEST(SameSource, OfCanIsBusProfileAndSensorId) {
  RadarConfig radar;
  radar.profile = RadarProfile::kArs408;
  radar.source.interface = "can1";
  RadarConfig other = radar;
  EXPECT_TRUE(is_same_source(radar, other));
  other.sensor_id = 1;
  EXPECT_FALSE(is_same_source(radar, other));
  other = radar;
  other.profile = RadarProfile::kSrr520;
  EXPECT_FALSE(is_same_source(radar, other));
  other = radar;
  other.source.interface = "can2";
  EXPECT_FALSE(is_same_source(radar, other));
}

}  // namespace
}  // namespace boresight::config
