// `boresight decode` on a simulated drive: tables, verdicts, exit codes, and that nothing but the recording matters.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Decode : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (const auto& file : harness::simulated_drive(5.0)) files_.push_back(file);
  }
  static std::string all_files() {
    std::string list;
    for (const auto& file : files_) list += " " + file.string();
    return list;
  }
  /// Runs the command in a shell; returns its exit code, what it printed is in output().
  static int decode(const std::string& arguments, const std::string& before = "") {
    const std::string command = before +
                                BORESIGHT_BINARY_DIR "/boresight decode --config " BORESIGHT_SOURCE_DIR "/config " +
                                arguments + " > /tmp/decode.out 2> /tmp/decode.err";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static std::string output() { return text_of("/tmp/decode.out"); }
  static std::string errors() { return text_of("/tmp/decode.err"); }
  static std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

  inline static std::vector<std::filesystem::path> files_;
};

TEST_F(Decode, ADriveIsSoundAndItsTableHasARowForEachDetection) {
  ASSERT_EQ(decode("--vehicle demo --check" + all_files()), 0) << output() << errors();
  const std::string report = output();
  EXPECT_THAT(report, testing::EndsWith("\nSOUND\n"));
  std::ptrdiff_t detections = 0;
  for (std::size_t at = report.find(" scans, "); at != std::string::npos; at = report.find(" scans, ", at + 1)) {
    detections += std::atoi(report.c_str() + at + 8);
  }
  EXPECT_GT(detections, 1000);
  ASSERT_EQ(decode("--vehicle demo --csv" + all_files()), 0) << errors();
  EXPECT_EQ(lines(output()), 1 + detections);
  EXPECT_THAT(output(), testing::StartsWith("time_s,radar,cycle,index,range_m,"));
  ASSERT_EQ(decode("--vehicle demo --ego" + all_files()), 0) << errors();
  EXPECT_GT(lines(output()), 100);
}

TEST_F(Decode, TheSameRecordingGivesTheSameBytesHoweverFastItComes) {
  ASSERT_EQ(decode("--vehicle demo --csv " + files_.front().string()), 0) << errors();
  const std::string once = output();
  ASSERT_GT(once.size(), 10'000u);
  ASSERT_EQ(decode("--vehicle demo --csv " + files_.front().string()), 0) << errors();
  EXPECT_TRUE(output() == once) << "again";
  ASSERT_EQ(decode("--vehicle demo --csv -", "cat " + files_.front().string() + " | "), 0) << errors();
  EXPECT_TRUE(output() == once) << "by a pipe";
  const std::string slowly = "{ head -c 100000 " + files_.front().string() + "; sleep 0.5; tail -c +100001 " +
                             files_.front().string() + "; } | ";
  ASSERT_EQ(decode("--vehicle demo --csv -", slowly), 0) << errors();
  EXPECT_TRUE(output() == once) << "by a pipe that pauses";
  ASSERT_EQ(decode("--vehicle demo --csv --out /tmp/table.csv " + files_.front().string()), 0) << errors();
  EXPECT_TRUE(text_of("/tmp/table.csv") == once) << "to a file";
}

TEST_F(Decode, DamageIsFoundWhateverItIs) {
  const std::string whole = text_of(files_.front());
  const auto check = [&](const std::string& damaged) {
    std::ofstream("/tmp/damaged.pcap", std::ios::binary) << damaged;
    return decode("--profile ars548 --check /tmp/damaged.pcap");
  };
  EXPECT_EQ(check(whole), 0) << output();
  EXPECT_EQ(check(whole.substr(0, whole.size() - 40)), 1) << "cut";
  std::string other = whole;
  for (std::size_t at = other.size() / 2; at < other.size() / 2 + 3000; ++at) other[at] = '\x55';
  EXPECT_EQ(check(other), 1) << "overwritten: " << output();
  EXPECT_THAT(output(), HasSubstr("DAMAGED"));
  EXPECT_EQ(check(""), 1) << "empty";
}

TEST_F(Decode, WrongCommandLinesAndFilesAreNamed) {
  EXPECT_EQ(decode("--csv " + files_.front().string()), 2);
  EXPECT_THAT(errors(), HasSubstr("--profile or --vehicle"));
  EXPECT_EQ(decode("--profile ars548 " + files_.front().string()), 2);
  EXPECT_THAT(errors(), HasSubstr("--csv, --ego and --check"));
  EXPECT_EQ(decode("--profile unheard --csv x"), 2);
  EXPECT_EQ(decode("--vehicle unheard --csv x"), 2);
  EXPECT_THAT(errors(), HasSubstr("no vehicle 'unheard' in " BORESIGHT_SOURCE_DIR "/config/vehicle"));
  EXPECT_THAT(errors(), HasSubstr(", demo, "));
  EXPECT_EQ(decode("--profile ars548 --csv /tmp/absent.pcap"), 3);
  EXPECT_THAT(errors(), HasSubstr("/tmp/absent.pcap"));
  EXPECT_EQ(decode("--profile ars548 --csv --out /dev/full " + files_.front().string()), 3);
  EXPECT_THAT(errors(), HasSubstr("/dev/full: cannot be written: No space left on device"));
}

}  // namespace
}  // namespace boresight
