#include "deploy/supervisor/supervisor.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "deploy/supervisor/domain.hpp"
#include "tests/unit/deploy/fake_domain.hpp"

namespace boresight::supervisor {
namespace {

TEST_F(SupervisorTest, StartsRoudiFirstAndStopLeavesNothing) {
  std::ofstream(bus() / "foreign") << "not ours";
  Supervisor supervisor(domain({service("a"), service("b")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const std::vector<pid_t> pids = {supervisor.roudi_pid(), supervisor.pid_of("a"), supervisor.pid_of("b")};
  EXPECT_THAT(files_on_bus(), ::testing::IsSupersetOf({"iceoryx_mgmt", "some_group", "socket-a", "socket-b"}));
  EXPECT_EQ(supervisor.events().at(0).process, "roudi");
  EXPECT_EQ(supervisor.events().at(1).kind, EventKind::kReady) << "services start only after RouDi is ready";
  supervisor.stop();
  for (const pid_t pid : pids) EXPECT_TRUE(is_gone(pid));
  EXPECT_THAT(files_on_bus(), ::testing::ElementsAre("foreign"));
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "run"));
  EXPECT_TRUE(std::filesystem::exists(directory_ / "logs" / "a.log"));
}

TEST_F(SupervisorTest, RoudiStopsLast) {
  Supervisor supervisor(domain({service("a")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  supervisor.stop();
  std::vector<std::string> order;
  for (const Event& event : supervisor.events()) {
    if (event.kind == EventKind::kExited) order.push_back(event.process);
  }
  EXPECT_THAT(order, ::testing::ElementsAre("a", "roudi"));
}

TEST_F(SupervisorTest, KilledServiceIsStartedAgainAtOnceAlone) {
  Supervisor supervisor(domain({service("a"), service("b")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t a = supervisor.pid_of("a");
  const pid_t b = supervisor.pid_of("b");
  const std::int64_t killed_ms = milliseconds_now();
  kill(a, SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.pid_of("a") != a && supervisor.all_ready(); }));
  EXPECT_LT(milliseconds_now() - killed_ms, 1000);
  EXPECT_EQ(supervisor.pid_of("b"), b);
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
  const auto exited = std::find_if(supervisor.events().begin(), supervisor.events().end(),
                                   [](const Event& e) { return e.kind == EventKind::kExited; });
  ASSERT_NE(exited, supervisor.events().end());
  EXPECT_EQ(exited->detail, "signal 9 (Killed)");
}

TEST_F(SupervisorTest, ServiceThatFailsAgainAndAgainIsHeldBack) {
  Supervisor supervisor(domain({service("a", "fail")}));
  supervisor.start();
  for (int i = 0; i < 120; ++i) supervisor.poll(10'000'000);
  // At 0, 0, 0.25 and 0.75 s; the next one only at 1.75 s.
  EXPECT_GE(count(supervisor, EventKind::kSpawned, "a"), 3U);
  EXPECT_LE(count(supervisor, EventKind::kSpawned, "a"), 4U);
  EXPECT_FALSE(supervisor.all_ready());
}

TEST(RestartDelay, GrowsFromNothingToFiveSeconds) {
  EXPECT_EQ(restart_delay_ns(1), 0);
  EXPECT_EQ(restart_delay_ns(2), 250'000'000);
  EXPECT_EQ(restart_delay_ns(3), 500'000'000);
  EXPECT_EQ(restart_delay_ns(50), 5'000'000'000);
}

TEST_F(SupervisorTest, KilledRoudiRestartsTheWholeDomain) {
  Supervisor supervisor(domain({service("a"), service("b")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const std::vector<pid_t> before = {supervisor.roudi_pid(), supervisor.pid_of("a"), supervisor.pid_of("b")};
  const std::int64_t killed_ms = milliseconds_now();
  kill(supervisor.roudi_pid(), SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
  EXPECT_LT(milliseconds_now() - killed_ms, 2000);
  for (const pid_t pid : before) EXPECT_TRUE(is_gone(pid));
  EXPECT_NE(supervisor.pid_of("b"), 0);
}

TEST_F(SupervisorTest, ReplacedManagementMemoryRestartsTheWholeDomain) {
  Supervisor supervisor(domain({service("a")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  // The new file exists before the old one goes, so that it cannot get the same inode.
  std::ofstream(bus() / "other") << "memory";
  std::filesystem::rename(bus() / "other", bus() / "iceoryx_mgmt");
  EXPECT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
}

TEST_F(SupervisorTest, RespawnedServiceThatHangsRestartsTheWholeDomain) {
  DomainConfig config = domain({service("a", "hang_later"), service("b")});
  config.service_ready_timeout_ns = 200'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  kill(supervisor.pid_of("a"), SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1; }));
  const auto restart = std::find_if(supervisor.events().begin(), supervisor.events().end(),
                                    [](const Event& e) { return e.kind == EventKind::kDomainRestart; });
  EXPECT_EQ(restart->detail, "a does not become ready");
}

TEST_F(SupervisorTest, RoudiThatHangsAfterARestartIsTriedAgain) {
  DomainConfig config = domain({service("a")}, "silent_later");
  config.roudi_ready_timeout_ns = 200'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  kill(supervisor.roudi_pid(), SIGKILL);
  EXPECT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() >= 2; }));
  EXPECT_GE(count(supervisor, EventKind::kStartFailed, "roudi"), 1U);
}

TEST_F(SupervisorTest, SpectatorIsNotWaitedForAndIndependentOutlivesARestart) {
  ProcessSpec spectator = service("eyes", "hang_later");
  std::ofstream(bus() / "socket-eyes.started") << "";  // so that it never reports itself ready
  spectator.role = Role::kSpectator;
  Supervisor supervisor(domain({service("a"), spectator}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  supervisor.start_independent({.name = "player",
                                .command = {.arguments = {"/bin/sh", "-c", "sleep 0.4; exit 7"}, .environment = {}},
                                .runtime_name = "",
                                .role = Role::kIndependent});
  kill(supervisor.roudi_pid(), SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.independent_result("player").has_value(); }));
  EXPECT_EQ(WEXITSTATUS(*supervisor.independent_result("player")), 7);
  EXPECT_EQ(count(supervisor, EventKind::kSpawned, "player"), 1U);
}

TEST_F(SupervisorTest, DeafServiceIsKilledAfterTheTimeout) {
  Supervisor supervisor(domain({service("a", "deaf")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t pid = supervisor.pid_of("a");
  const std::int64_t begin_ms = milliseconds_now();
  supervisor.stop();
  EXPECT_GE(milliseconds_now() - begin_ms, 290);
  EXPECT_TRUE(is_gone(pid));
}

TEST_F(SupervisorTest, RefusesBesideAnotherRoudiAndTouchesNothing) {
  const path lock = bus() / "iox-unique-roudi.lock";
  const int descriptor = open(lock.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  ASSERT_EQ(flock(descriptor, LOCK_EX | LOCK_NB), 0);
  std::ofstream(bus() / "iceoryx_mgmt") << "theirs";
  {
    Supervisor supervisor(domain({service("a")}));
    try {
      supervisor.start();
      FAIL() << "started beside another RouDi";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("another RouDi runs"));
    }
  }
  EXPECT_THAT(files_on_bus(), ::testing::ElementsAre("iceoryx_mgmt", "iox-unique-roudi.lock"));
  close(descriptor);
}

TEST_F(SupervisorTest, StaleLockOfAKilledRoudiIsNoHindrance) {
  std::ofstream(bus() / "iox-unique-roudi.lock") << "";
  Supervisor supervisor(domain({service("a")}));
  supervisor.start();
  EXPECT_TRUE(become_ready(supervisor));
}

TEST_F(SupervisorTest, RoudiThatEndsAtOnceIsAnError) {
  Supervisor supervisor(domain({service("a")}, "fail"));
  EXPECT_THROW(supervisor.start(), std::runtime_error);
  EXPECT_EQ(supervisor.pid_of("a"), 0);
}

TEST_F(SupervisorTest, MissingProgramIsReported) {
  ProcessSpec missing = service("a");
  missing.command.arguments[0] = "/nonexistent/boresight-a";
  Supervisor supervisor(domain({missing}));
  supervisor.start();
  EXPECT_EQ(count(supervisor, EventKind::kStartFailed, "a"), 1U);
  DomainConfig config = domain({});
  config.roudi.arguments[0] = "/nonexistent/iox-roudi";
  supervisor.stop();
  Supervisor without(config);
  EXPECT_THROW(without.start(), std::runtime_error);
}

TEST_F(SupervisorTest, RunDirectoryThatAKilledOneLeftIsNotTaken) {
  const path first = unused_run_directory(directory_);
  EXPECT_EQ(first.parent_path(), directory_);
  std::filesystem::create_directory(first);
  const path second = unused_run_directory(directory_);
  EXPECT_NE(second, first);
  EXPECT_FALSE(std::filesystem::exists(second));
}

TEST_F(SupervisorTest, OutputOfAServiceGoesToItsLog) {
  ProcessSpec talker = service("talker");
  talker.command.arguments = {"/bin/sh", "-c", "echo to-out; echo to-err >&2; exec sleep 100"};
  Supervisor supervisor(domain({talker}));
  supervisor.start();
  const auto log = [&] {
    std::ostringstream text;
    text << std::ifstream(directory_ / "logs" / "talker.log").rdbuf();
    return text.str();
  };
  EXPECT_TRUE(poll_until(supervisor, [&] { return log() == "to-out\nto-err\n"; })) << log();
}

TEST(ReservedSegments, AreReadFromWhatRoudiPrints) {
  EXPECT_THAT(reserved_segments("Reserving 65725528 bytes in the shared memory [iceoryx_mgmt]\n"
                                "[ Reserving shared memory successful ] \n"
                                "Reserving 16800 bytes in the shared memory [root]\n"),
              ::testing::ElementsAre("iceoryx_mgmt", "root"));
  EXPECT_THAT(reserved_segments("bytes in the shared memory [../etc/passwd]"), ::testing::IsEmpty());
  EXPECT_THAT(reserved_segments("bytes in the shared memory [cut"), ::testing::IsEmpty());
}

}  // namespace
}  // namespace boresight::supervisor
