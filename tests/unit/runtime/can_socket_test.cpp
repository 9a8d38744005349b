#include "services/common/runtime/can_socket.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace boresight::runtime {
namespace {

recording::Frame frame_of(std::uint32_t id, const std::vector<std::uint8_t>& payload, bool fd = false) {
  recording::Frame frame;
  frame.kind = fd ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
  frame.can_id = id;
  frame.can_extended = id > 0x7FF;
  frame.payload = payload;
  return frame;
}

TEST(CanSocket, FramesAreReadAsTheyWereWritten) {
  for (const bool fd : {false, true}) {
    for (const std::uint32_t id : {0u, 0x7FFu, 0x800u, 0x1FFFFFFFu}) {
      const std::vector<std::uint8_t> payload(fd ? 48 : 5, 0xA5);
      recording::Frame given = frame_of(id, payload, fd);
      given.can_fd_flags = fd ? CANFD_BRS : 0;
      canfd_frame raw{};
      const std::size_t size = to_kernel(given, raw);
      EXPECT_EQ(size, fd ? CANFD_MTU : CAN_MTU);
      recording::Frame back;
      ASSERT_EQ(from_kernel(raw, static_cast<ssize_t>(size), back), CanFrameKind::kData);
      EXPECT_EQ(back.kind, given.kind);
      EXPECT_EQ(back.can_id, id);
      EXPECT_EQ(back.can_extended, given.can_extended);
      EXPECT_EQ(back.can_fd_flags, given.can_fd_flags);
      EXPECT_TRUE(std::equal(payload.begin(), payload.end(), back.payload.begin(), back.payload.end()));
    }
  }
}

TEST(CanSocket, RemoteAndErrorFramesAreDistinguished) {
  canfd_frame raw{};
  recording::Frame frame = frame_of(0x123, {});
  frame.can_remote = true;
  const std::size_t size = to_kernel(frame, raw);
  recording::Frame back;
  ASSERT_EQ(from_kernel(raw, static_cast<ssize_t>(size), back), CanFrameKind::kData);
  EXPECT_TRUE(back.can_remote);
  raw.can_id = CAN_ERR_FLAG | 0x1004;
  EXPECT_EQ(from_kernel(raw, CAN_MTU, back), CanFrameKind::kError);
  EXPECT_EQ(back.can_id, 0x1004u) << "the classes of error, beyond the bits of a standard id";
}

TEST(CanSocket, WrongLengthsAreNotRead) {
  canfd_frame raw{};
  recording::Frame frame;
  for (const ssize_t length : {ssize_t{0}, ssize_t{CAN_MTU} - 1, ssize_t{CAN_MTU} + 1, ssize_t{CANFD_MTU} + 1}) {
    EXPECT_EQ(from_kernel(raw, length, frame), CanFrameKind::kWrongLength) << length;
  }
  raw.len = 9;
  EXPECT_EQ(from_kernel(raw, CAN_MTU, frame), CanFrameKind::kWrongLength);
  raw.len = 65;
  EXPECT_EQ(from_kernel(raw, CANFD_MTU, frame), CanFrameKind::kWrongLength);
}

TEST(CanSocket, PayloadsAreCutToTheKindOfFrame) {
  canfd_frame raw{};
  const std::vector<std::uint8_t> payload(80, 1);
  EXPECT_EQ(to_kernel(frame_of(1, payload), raw), CAN_MTU);
  EXPECT_EQ(raw.len, 8);
  EXPECT_EQ(to_kernel(frame_of(1, payload, true), raw), CANFD_MTU);
  EXPECT_EQ(raw.len, 64);
}

TEST(CanSocket, AMissingInterfaceIsNamed) {
  std::string problem;
  EXPECT_EQ(open_can_socket("nosuchcan0", false, problem), -1);
  EXPECT_FALSE(problem.empty()) << "no CAN in the kernel, or no such interface";
}

}  // namespace
}  // namespace boresight::runtime
