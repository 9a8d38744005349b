#include "services/ingest_gateway/codecs/ars408_commands.hpp"

#include <array>
#include <cstdio>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace boresight::ingest {
namespace {

std::string hex(const std::optional<ars408::CommandFrame>& frame) {
  if (!frame) return "none";
  std::string text;
  for (const std::uint8_t byte : frame->payload()) {
    std::array<char, 3> digits{};
    std::snprintf(digits.data(), digits.size(), "%02X", unsigned{byte});
    text += digits.data();
  }
  return text;
}

EgoMotion ego(float speed_mps, float yaw_rate_radps) {
  EgoMotion motion{};
  motion.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse;
  motion.speed_mps = speed_mps;
  motion.yaw_rate_radps = yaw_rate_radps;
  return motion;
}

TEST(Ars408Commands, ConfigureTheOutputOfTheSensorAddressed) {
  EXPECT_EQ(hex(ars408::configuration(ars408::Output::kClusters, 0)), "F8000000109C0000");
  EXPECT_EQ(hex(ars408::configuration(ars408::Output::kObjects, 0)), "F8000000089C0000");
  EXPECT_EQ(ars408::configuration(ars408::Output::kClusters, 0).can_id, 0x200u);
  EXPECT_EQ(ars408::configuration(ars408::Output::kClusters, 5).can_id, 0x250u);
}

TEST(Ars408Commands, TellTheSpeedWithItsDirection) {
  EXPECT_EQ(hex(ars408::ego_speed(ego(10.0F, 0.0F), 0)), "41F4");   // forward, 500
  EXPECT_EQ(hex(ars408::ego_speed(ego(-10.0F, 0.0F), 0)), "81F4");  // backward, 500
  EXPECT_EQ(hex(ars408::ego_speed(ego(0.0F, 0.0F), 0)), "0000");
  EXPECT_EQ(hex(ars408::ego_speed(ego(0.009F, 0.0F), 0)), "0000") << "below the signal's resolution";
  EXPECT_EQ(hex(ars408::ego_speed(ego(0.02F, 0.0F), 0)), "4001");
  EXPECT_EQ(hex(ars408::ego_speed(ego(500.0F, 0.0F), 0)), "5FFF") << "limited to the signal's range";
  EXPECT_EQ(ars408::ego_speed(ego(10.0F, 0.0F), 2)->can_id, 0x320u);
  EgoMotion motion = ego(-10.0F, 0.0F);
  motion.fields = ego_field::kSpeed;
  EXPECT_EQ(hex(ars408::ego_speed(motion, 0)), "41F4") << "no direction known";
  motion.fields = ego_field::kYawRate;
  EXPECT_EQ(hex(ars408::ego_speed(motion, 0)), "none");
  EXPECT_EQ(hex(ars408::ego_speed(ego(NAN, 0.0F), 0)), "none");
  EXPECT_EQ(hex(ars408::ego_speed(ego(INFINITY, 0.0F), 0)), "none");
}

TEST(Ars408Commands, TellTheYawRate) {
  EXPECT_EQ(hex(ars408::ego_yaw_rate(ego(0.0F, 0.0F), 0)), "8000");
  EXPECT_EQ(hex(ars408::ego_yaw_rate(ego(0.0F, static_cast<float>(M_PI / 18.0)), 0)), "83E8");  // +10 °/s
  EXPECT_EQ(hex(ars408::ego_yaw_rate(ego(0.0F, 100.0F), 0)), "FFFF");
  EXPECT_EQ(hex(ars408::ego_yaw_rate(ego(0.0F, -100.0F), 0)), "0000");
  EXPECT_EQ(ars408::ego_yaw_rate(ego(0.0F, 0.0F), 7)->can_id, 0x371u);
  EXPECT_EQ(hex(ars408::ego_yaw_rate(ego(0.0F, NAN), 0)), "none");
  EgoMotion motion = ego(0.0F, 0.1F);
  motion.fields = ego_field::kSpeed;
  EXPECT_EQ(hex(ars408::ego_yaw_rate(motion, 0)), "none");
}

}  // namespace
}  // namespace boresight::ingest
