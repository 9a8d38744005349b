#include "services/boresight/record/can_capture.hpp"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/boresight/record/capture_error.hpp"

namespace boresight::record {
namespace {

/// Datagrams of a Unix socket instead of frames of a CAN socket: most machines that test have no CAN.
class CanCaptureTest : public testing::Test {
 protected:
  CanCaptureTest()
      : file_(std::filesystem::temp_directory_path() / ("boresight_can_capture_" + std::to_string(getpid()) + ".log")) {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
    bus_ = ingest::Socket(ends[0]);
    capture_ = std::make_unique<CanCapture>("can7", ingest::Socket(ends[1]));
    writer_ = std::make_unique<recording::CandumpWriter>(file_);
  }
  ~CanCaptureTest() override { std::filesystem::remove(file_); }

  void send(canid_t id, std::string_view data, std::size_t size = CAN_MTU, std::uint8_t flags = 0) {
    canfd_frame frame{};
    frame.can_id = id;
    frame.len = static_cast<std::uint8_t>(data.size());
    frame.flags = flags;
    std::copy(data.begin(), data.end(), frame.data);
    ASSERT_EQ(::send(bus_.get(), &frame, size, 0), static_cast<ssize_t>(size));
  }
  /// The log's lines without their stamps.
  std::vector<std::string> lines() {
    writer_->flush();
    std::ifstream file(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line.substr(line.find(' ') + 1));
    return lines;
  }

  std::filesystem::path file_;
  ingest::Socket bus_;
  std::unique_ptr<CanCapture> capture_;
  std::unique_ptr<recording::CandumpWriter> writer_;
  std::string problem_;
};

TEST_F(CanCaptureTest, EveryKindOfFrameIsWrittenAsCandumpWould) {
  send(0x123, "AB");
  send(0x18DAF110 | CAN_EFF_FLAG, "");
  send(0x123 | CAN_RTR_FLAG, "12345678");
  send(CAN_ERR_FLAG | 0x4, "\1\2");
  send(0x7FF, std::string(64, 'x'), CANFD_MTU, CANFD_BRS | 0x04);
  capture_->read(*writer_, problem_);
  EXPECT_EQ(problem_, "");
  std::string sixty_four = "can7 7FF##1";
  for (int i = 0; i < 64; ++i) sixty_four += "78";
  EXPECT_THAT(lines(),
              testing::ElementsAre("can7 123#4142", "can7 18DAF110#", "can7 123#R8", "can7 20000004#0102", sixty_four));
  EXPECT_EQ(capture_->frames(), 5u);
  EXPECT_EQ(capture_->dropped(), 0u);
}

TEST_F(CanCaptureTest, StampsAreSecondsSinceTheEpoch) {
  send(0x123, "AB");
  capture_->read(*writer_, problem_);
  writer_->flush();
  std::ifstream file(file_);
  char bracket = 0;
  double stamp_s = 0.0;
  file >> bracket >> stamp_s;
  EXPECT_NEAR(stamp_s, static_cast<double>(std::time(nullptr)), 5.0);
}

TEST_F(CanCaptureTest, AFrameOfAWrongLengthIsReportedAndSkipped) {
  send(0x123, "AB", 10);
  capture_->read(*writer_, problem_);
  EXPECT_THAT(problem_, testing::HasSubstr("can7: a frame with a wrong length"));
  send(0x124, "123456789", CAN_MTU);
  capture_->read(*writer_, problem_);
  EXPECT_THAT(problem_, testing::HasSubstr("wrong length"));
  send(0x125, "");
  capture_->read(*writer_, problem_);
  EXPECT_EQ(problem_, "");
  EXPECT_THAT(lines(), testing::ElementsAre("can7 125#"));
}

TEST(CanCapture, AnInterfaceThatIsNotThereIsNamed) {
  try {
    CanCapture capture("nocan9");
    ADD_FAILURE() << "opened";
  } catch (const CaptureError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nocan9"));
  }
}

}  // namespace
}  // namespace boresight::record
