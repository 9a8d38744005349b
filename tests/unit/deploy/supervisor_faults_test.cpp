// What the supervisor does with processes that hang, and with a configuration that is refused; what its guardian does
// after it was killed.
#include <array>
#include <fstream>

#include <sys/wait.h>

#include "deploy/supervisor/held_name.hpp"
#include "tests/unit/deploy/fake_domain.hpp"

namespace boresight::supervisor {
namespace {

using SupervisorFaults = SupervisorTest;

TEST_F(SupervisorFaults, ServiceWithoutStrokesIsEndedAndStartedAgainAlone) {
  DomainConfig config = domain({service("a", "mute_once"), service("b")});
  config.watchdog_timeout_ns = 300'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t b = supervisor.pid_of("b");
  EXPECT_TRUE(poll_until(supervisor,
                         [&] { return count(supervisor, EventKind::kSpawned, "a") == 2U && supervisor.all_ready(); }));
  EXPECT_EQ(count(supervisor, EventKind::kHung, "a"), 1U);
  EXPECT_EQ(supervisor.pid_of("b"), b);
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
}

TEST_F(SupervisorFaults, StoppedServiceIsKilledAsItCannotAbort) {
  DomainConfig config = domain({service("a")});
  config.watchdog_timeout_ns = 300'000'000;
  config.abort_timeout_ns = 100'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t a = supervisor.pid_of("a");
  kill(a, SIGSTOP);
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.pid_of("a") != a && supervisor.all_ready(); }));
  EXPECT_EQ(first_detail(supervisor, EventKind::kExited), "signal 9 (Killed)");
}

TEST_F(SupervisorFaults, StrokesAreNotMissedWhileTheSupervisorSleeps) {
  DomainConfig config = domain({service("a")});
  config.watchdog_timeout_ns = 300'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  usleep(1'000'000);
  for (int i = 0; i < 20; ++i) supervisor.poll(10'000'000);
  EXPECT_EQ(count(supervisor, EventKind::kHung, "a"), 0U);
}

TEST_F(SupervisorFaults, RoudiWithoutStrokesRestartsTheDomain) {
  DomainConfig config = domain({service("a")}, "mute_once");
  config.off_path_watchdog_timeout_ns = 300'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
  EXPECT_EQ(first_detail(supervisor, EventKind::kDomainRestart), "RouDi's watchdog is silent");
}

TEST_F(SupervisorFaults, ServiceOffTheDataPathThatHangsAtStartNeverCostsTheDomain) {
  ProcessSpec estimator = service("estimator", "hang_later");
  estimator.is_on_data_path = false;
  DomainConfig config = domain({estimator, service("b")});
  config.service_ready_timeout_ns = 100'000'000;
  config.abort_timeout_ns = 50'000'000;
  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t b = supervisor.pid_of("b");
  kill(supervisor.pid_of("estimator"), SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return count(supervisor, EventKind::kHung, "estimator") >= 3U; }));
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
  EXPECT_EQ(supervisor.pid_of("b"), b);
}

TEST_F(SupervisorFaults, ServiceOfADeadDomainThatIgnoresSigtermDelaysTheRestartLittle) {
  DomainConfig config = domain({service("a", "deaf")});
  config.stop_timeout_ns = 5'000'000'000;
  {
    Supervisor supervisor(config);
    supervisor.start();
    ASSERT_TRUE(become_ready(supervisor));
    const std::int64_t killed_ms = milliseconds_now();
    kill(supervisor.roudi_pid(), SIGKILL);
    ASSERT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
    EXPECT_LT(milliseconds_now() - killed_ms, 1000);
    kill(supervisor.pid_of("a"), SIGKILL);  // the regular stop waits longer
  }
}

TEST_F(SupervisorFaults, RemovedSegmentRestartsTheDomain) {
  Supervisor supervisor(domain({service("a")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  std::filesystem::remove(bus() / "some_group");
  EXPECT_TRUE(poll_until(supervisor, [&] { return supervisor.domain_restarts() == 1 && supervisor.all_ready(); }));
}

TEST_F(SupervisorFaults, RefusedConfigurationAtStartIsReportedWithItsReason) {
  Supervisor supervisor(domain({service("a", "refuse"), service("b")}));
  supervisor.start();
  ASSERT_TRUE(poll_until(supervisor, [&] { return !supervisor.refused_by().empty(); }));
  EXPECT_EQ(supervisor.refused_by(), "a");
  EXPECT_EQ(last_lines(directory_ / "logs" / "a.log", 1), "services/x.toml:3: key must be positive");
}

TEST_F(SupervisorFaults, ServiceThatRefusesLaterIsGivenUpUntilAFileChanges) {
  Supervisor supervisor(domain({service("a", "refuse_later"), service("b")}));
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t b = supervisor.pid_of("b");
  kill(supervisor.pid_of("a"), SIGKILL);
  ASSERT_TRUE(poll_until(supervisor, [&] { return count(supervisor, EventKind::kGivenUp, "a") == 1U; }));
  EXPECT_THAT(first_detail(supervisor, EventKind::kGivenUp), ::testing::HasSubstr("services/x.toml:4: unknown key"));
  EXPECT_EQ(supervisor.refused_by(), "") << "the domain goes on without it";
  const std::size_t tries = count(supervisor, EventKind::kSpawned, "a");
  EXPECT_EQ(tries, 1U + kConfigurationTries);
  for (int i = 0; i < 120; ++i) supervisor.poll(10'000'000);
  EXPECT_EQ(count(supervisor, EventKind::kSpawned, "a"), tries) << "no further try";
  std::ofstream(directory_ / "config" / "mended") << "";
  EXPECT_TRUE(poll_until(supervisor, [&] { return supervisor.pid_of("a") != 0 && supervisor.all_ready(); }));
  EXPECT_EQ(supervisor.pid_of("b"), b);
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
}

TEST_F(SupervisorFaults, LongLogIsRotatedWhileItsWriterGoesOn) {
  ProcessSpec talker = service("talker");
  talker.role = Role::kSpectator;
  talker.command.arguments = {"/bin/sh", "-c", "i=0; while :; do i=$((i+1)); echo line $i; sleep 0.005; done"};
  DomainConfig config = domain({talker});
  config.logs = {.max_bytes = 400, .kept_files = 2};
  Supervisor supervisor(config);
  supervisor.start();
  const path log = directory_ / "logs" / "talker.log";
  EXPECT_TRUE(poll_until(supervisor, [&] { return std::filesystem::exists(log.string() + ".2"); }));
  EXPECT_FALSE(std::filesystem::exists(log.string() + ".3"));
  EXPECT_THAT(last_lines(log.string() + ".2", 1), ::testing::StartsWith("line "));
}

TEST_F(SupervisorFaults, LogThatCannotBeOpenedIsNoHindrance) {
  std::filesystem::create_directories(directory_ / "logs" / "a.log");  // a folder where the file should be
  Supervisor supervisor(domain({service("a")}));
  supervisor.start();
  EXPECT_TRUE(become_ready(supervisor));
}

TEST_F(SupervisorFaults, SecondSupervisorIsRefusedAtOnce) {
  Supervisor first(domain({service("a")}));
  first.start();
  ASSERT_TRUE(become_ready(first));
  Supervisor second(domain({service("a")}));
  EXPECT_THROW(second.start(), std::runtime_error);
  first.poll(10'000'000);
  EXPECT_TRUE(first.all_ready());
  EXPECT_EQ(first.domain_restarts(), 0U);
}

TEST_F(SupervisorTest, KilledSupervisorLeavesNoProcessAndNoFile) {
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t child = fork();
  if (child == 0) {
    Supervisor supervisor(domain({service("a", "deaf"), service("b")}));
    supervisor.start();
    if (!become_ready(supervisor)) _exit(1);
    const std::array<pid_t, 3> pids = {supervisor.roudi_pid(), supervisor.pid_of("a"), supervisor.pid_of("b")};
    if (write(report[1], pids.data(), sizeof(pids)) != static_cast<ssize_t>(sizeof(pids))) _exit(1);
    for (;;) supervisor.poll(100'000'000);
  }
  std::array<pid_t, 3> pids{};
  ASSERT_EQ(read(report[0], pids.data(), sizeof(pids)), static_cast<ssize_t>(sizeof(pids)));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const std::int64_t deadline_ms = milliseconds_now() + 5000;
  const auto all_gone = [&] { return std::all_of(pids.begin(), pids.end(), is_gone) && files_on_bus().empty(); };
  while (!all_gone() && milliseconds_now() < deadline_ms) usleep(20'000);
  for (const pid_t pid : pids) EXPECT_TRUE(is_gone(pid));
  EXPECT_THAT(files_on_bus(), ::testing::IsEmpty());
  while (std::filesystem::exists(directory_ / "run") && milliseconds_now() < deadline_ms) usleep(20'000);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "run"));
  close(report[0]);
  close(report[1]);
}

/// A supervisor is killed, and a new one starts after the given number of milliseconds.
class SupervisorRestarted : public SupervisorTest, public ::testing::WithParamInterface<int> {};

TEST_P(SupervisorRestarted, HasItsDomainToItself) {
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const DomainConfig config = domain({service("a", "deaf"), service("b")});
  const pid_t child = fork();
  if (child == 0) {
    Supervisor supervisor(config);
    supervisor.start();
    if (!become_ready(supervisor)) _exit(1);
    if (write(report[1], "r", 1) != 1) _exit(1);
    for (;;) supervisor.poll(100'000'000);
  }
  char ready = 0;
  ASSERT_EQ(read(report[0], &ready, 1), 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  usleep(static_cast<useconds_t>(GetParam()) * 1000);

  Supervisor supervisor(config);
  supervisor.start();
  ASSERT_TRUE(become_ready(supervisor));
  const pid_t a = supervisor.pid_of("a");
  const std::vector<std::string> files = files_on_bus();
  EXPECT_THAT(files, ::testing::IsSupersetOf({"iceoryx_mgmt", "some_group", "socket-a", "socket-b"}));
  // Longer than the old guardian takes.
  for (int i = 0; i < 100; ++i) supervisor.poll(10'000'000);
  EXPECT_EQ(files_on_bus(), files);
  EXPECT_EQ(supervisor.pid_of("a"), a);
  EXPECT_EQ(supervisor.domain_restarts(), 0U);
  close(report[0]);
  close(report[1]);
}

INSTANTIATE_TEST_SUITE_P(After, SupervisorRestarted, ::testing::Values(0, 100, 300, 500, 1000, 2000),
                         [](const auto& info) { return std::to_string(info.param) + "ms"; });

TEST_F(SupervisorFaults, NameIsHeldByOneAndFreedWithItsHolder) {
  auto first = HeldName::take("test", directory_);
  ASSERT_TRUE(first);
  EXPECT_FALSE(HeldName::take("test", directory_));
  EXPECT_TRUE(HeldName::take("test", bus())) << "another folder is another domain";
  first.reset();
  EXPECT_TRUE(HeldName::take("test", directory_));
}

}  // namespace
}  // namespace boresight::supervisor
