// Commands that ask a health service by DDS end in time, with a reason, if nobody answers or only a part comes.
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "generated/fault_memoryPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kDomain = 78;
constexpr double kWait_s = 2.0;
/// Time to join and to leave on a busy machine; the tool's own limits are 10 s and 3 s.
constexpr double kMargin_s = 13.0;

struct End {
  int exit_code;
  std::string errors;
  double seconds;
};

End run(const std::string& arguments) {
  const std::string command = "BORESIGHT_DDS_DOMAIN=" + std::to_string(kDomain) + " " + BORESIGHT_TOOL + " " +
                              arguments + " > /tmp/output.txt 2> /tmp/errors.txt";
  const auto begin = std::chrono::steady_clock::now();
  const int status = std::system(command.c_str());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  std::ifstream errors("/tmp/errors.txt");
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .errors = {std::istreambuf_iterator<char>(errors), {}},
          .seconds = elapsed.count()};
}

std::string limited(const std::string& command) {
  return "dtc " + command + " --seconds " + std::to_string(kWait_s);
}

std::string with_key(const std::string& command) {
  std::ofstream("/tmp/command.key") << std::string(64, 'k');
  chmod("/tmp/command.key", 0600);
  return limited(command) + " --key /tmp/command.key";
}

/// A health service that states what it has stored and what it accepts, and sends nothing else.
class SilentService {
 public:
  explicit SilentService(std::uint32_t stored)
      : participant_({.domain = kDomain, .command_key_file = {}}, "silent"),
        state_(participant_.writer(dds::kFaultMemoryStateTopic, dds::guarded<diagnostics::FaultMemoryStatePubSubType>(
                                                                    dds::kFaultMemoryStateTopic))) {
    static_cast<void>(participant_.writer(dds::kCommandReplyTopic,
                                          dds::guarded<diagnostics::CommandReplyPubSubType>(dds::kCommandReplyTopic)));
    participant_.reader(dds::kCommandTopic, dds::guarded<diagnostics::ClearCommandPubSubType>(dds::kCommandTopic),
                        nullptr);
    diagnostics::FaultMemoryState state;
    state.vehicle_name("car");
    state.stored(stored);
    state.accepts_commands(true);
    state_.write(&state);
  }

 private:
  dds::Participant participant_;
  eprosima::fastdds::dds::DataWriter& state_;
};

void expect_finding(const End& end, const std::string& reason) {
  EXPECT_EQ(end.exit_code, 1) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr(reason));
  EXPECT_LT(end.seconds, kWait_s + kMargin_s);
}

TEST(DtcByDds, EndsInTimeWithoutAService) {
  const std::string reason = "no health service answered on DDS domain 78 within 2 s";
  expect_finding(run(limited("list")), reason);
  expect_finding(run(limited("show C1D02-78")), reason);
  expect_finding(run(with_key("clear")), reason);
}

TEST(DtcByDds, ListEndsInTimeIfTheCodesNeverCome) {
  const SilentService service(2);
  expect_finding(run(limited("list")),
                 "the health service on DDS domain 78 answered, but only 0 of 2 codes arrived within 2 s");
}

TEST(DtcByDds, ClearEndsInTimeIfTheReplyNeverComes) {
  const SilentService service(0);
  expect_finding(run(with_key("clear")),
                 "the health service on DDS domain 78 answered, but did not reply to the command within 2 s");
}

TEST(DtcByDds, AnswerOfAServiceWithoutCodesIsTheEmptyList) {
  const SilentService service(0);
  const End end = run(limited("list"));
  EXPECT_EQ(end.exit_code, 0) << end.errors;
  EXPECT_LT(end.seconds, kWait_s + kMargin_s);
}

TEST(DiagnosticsByDds, EndsInTimeWithoutAService) {
  expect_finding(run("diagnostics --seconds 2"), "nothing was received on DDS domain 78");
}

}  // namespace
}  // namespace boresight
