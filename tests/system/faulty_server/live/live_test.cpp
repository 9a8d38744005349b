// The live gateway against story.py in another network namespace: a faulty server, other servers and storms of service
// discovery. Every list of a good server is delivered once and bitwise equal; no other list is delivered. Every fault
// is counted. A server that starts is served within one offer cycle in all cases.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interfaces/messages/names.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/node.hpp"
#include "tests/system/faulty_server/known.hpp"
#include "tests/system/harness/child.hpp"
#include "tests/system/harness/roudi.hpp"

namespace boresight::faulty_server {
namespace {

namespace fs = std::filesystem;
using harness::Child;

const fs::path kRoom = fs::path(BORESIGHT_SOURCE_DIR) / "tests/system/faulty_server";
constexpr double kOfferCycle_s = 1.0;
constexpr double kLoadedMachine_s = 0.3;

// --- what the gateway published --------------------------------------------------------------------------------------

struct SeenScan {
  std::int64_t received_ns;
  std::uint32_t radar, cycle;
  bool is_right;
  std::array<char, 100> difference;
};

struct SeenStatus {
  std::int64_t received_ns;
  std::array<std::uint64_t, kNumberOfFaults> faults;
  std::uint64_t heap_allocations;
  std::array<char, 128> last_fault;
};

struct Seen {
  volatile bool attached;
  volatile std::size_t scans, statuses;
  std::array<SeenScan, 10'000> scan;
  std::array<SeenStatus, 3'000> status;
};

int observe(Seen& seen) {
  runtime::Node node(catalogue::Service::kMonitor, "-faulty");
  node.on<RadarScan>([&](const RadarScan& scan) {
    if (seen.scans >= seen.scan.size()) return;
    SeenScan& s = seen.scan[seen.scans];
    // The document leaves the number of detections to the server: radar 1 sends 200 and radar 2 sends 20.
    const KnownScan known{scan.header.source_id, scan.cycle_counter, scan.header.source_id == 1 ? 200u : 20u,
                          Variant::kPlain};
    const std::string problem = difference(scan, known);
    s.received_ns = runtime::monotonic_now_ns();
    s.radar = known.radar;
    s.cycle = known.cycle;
    s.is_right = problem.empty();
    problem.copy(s.difference.data(), s.difference.size() - 1);
    seen.scans = seen.scans + 1;
  });
  node.on<ServiceStatus>([&](const ServiceStatus& status) {
    const bool is_gateway = status.header.source_id == static_cast<std::uint32_t>(catalogue::Service::kIngestGateway);
    if (!is_gateway || seen.statuses >= seen.status.size()) return;
    seen.status[seen.statuses] = {runtime::monotonic_now_ns(), status.faults, status.heap_allocations,
                                  status.last_fault};
    seen.statuses = seen.statuses + 1;
  });
  seen.attached = true;
  return node.spin();
}

// --- expected results of the story ----------------------------------------------------------------------------------

struct Stage {
  std::string name;
  std::int64_t begin_ns = 0, end_ns = 0;
  bool fresh = false, exact = true;
  std::vector<KnownScan> sent;
  std::array<std::uint64_t, kNumberOfFaults> faults{};
};

constexpr std::array kCounted = {Fault::kWireLength, Fault::kWireValue, Fault::kWireUnknown, Fault::kCapacity};

std::vector<Stage> read_story(const fs::path& file) {
  const config::Range any{0, 1e6}, number{0, 4294967295.0}, time{0, 9e18};
  auto root = config::Reader::open(file);
  std::vector<Stage> stages;
  for (config::Reader& table : root.tables("stage")) {
    Stage& stage = stages.emplace_back();
    stage.name = table.text("name", "");
    stage.begin_ns = table.integer("begin_ns", time, 0);
    stage.end_ns = table.integer("end_ns", time, 0);
    stage.fresh = table.boolean("fresh", false);
    stage.exact = table.boolean("exact", true);
    const std::vector<std::int64_t> sent = table.integers("sent", any, number, {});
    for (std::size_t i = 0; i + 4 <= sent.size(); i += 4) {
      stage.sent.push_back({static_cast<std::uint32_t>(sent[i]), static_cast<std::uint32_t>(sent[i + 1]),
                            static_cast<std::uint32_t>(sent[i + 2]), Variant::kPlain});
    }
    for (const std::string& line : table.texts("faults", {})) {
      for (const Fault kind : kCounted) {
        if (line.substr(line.find('|') + 1) == name_of(kind)) {
          stage.faults[static_cast<std::size_t>(kind)] = std::stoul(line);
        }
      }
    }
  }
  root.finish();
  return stages;
}

// --- the two networks ------------------------------------------------------------------------------------------------

bool run(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

/// Runs a program in a fork, with its output in a file.
std::unique_ptr<Child> start(std::vector<std::string> arguments, const fs::path& output, bool own_network) {
  return std::make_unique<Child>([=]() mutable {
    if (own_network && unshare(CLONE_NEWNET) != 0) return 97;
    const int file = open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(pointers[0], pointers.data());
    return 98;
  });
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class FaultyServerLive : public testing::Test {
 protected:
  void SetUp() override {
    if (!run("command -v ip")) GTEST_SKIP() << "skipped: no ip";
    if (!run("/usr/bin/python3 -c 'import scapy.contrib.automotive.someip'")) GTEST_SKIP() << "skipped: no scapy";
    if (unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "skipped: network namespaces are not permitted";
    if (!run("ip link set lo up && ip link add client0 address 02:00:00:00:00:02 type veth peer name server0")) {
      GTEST_SKIP() << "skipped: no veth";
    }
    ASSERT_TRUE(run("ip address add 10.66.85.2/16 dev client0 && ip link set client0 up"));
    fs::create_directories("/tmp/config/vehicle");
    fs::copy(fs::path(BORESIGHT_SOURCE_DIR) / "config/services", "/tmp/config/services",
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    fs::copy_file(kRoom / "vehicle.toml", "/tmp/config/vehicle/faulty_server.toml",
                  fs::copy_options::overwrite_existing);
    setenv("BORESIGHT_INPUT", "live", 1);
    setenv("BORESIGHT_RUNTIME_DIR", "/tmp/run", 1);
    fs::create_directories("/tmp/run");
  }
};

/// The last status before the time.
const SeenStatus& status_before(const Seen& seen, std::int64_t time_ns) {
  std::size_t i = seen.statuses;
  while (i > 1 && seen.status[i - 1].received_ns > time_ns) --i;
  return seen.status[i - 1];
}

void judge_scans(const Seen& seen, const std::vector<Stage>& stages) {
  for (const std::uint32_t radar : {1u, 2u}) {
    std::vector<std::uint32_t> sent, delivered;
    for (const Stage& stage : stages) {
      for (const KnownScan& scan : stage.sent) {
        if (scan.radar == radar) sent.push_back(scan.cycle);
      }
    }
    for (std::size_t i = 0; i < seen.scans; ++i) {
      if (seen.scan[i].radar == radar) delivered.push_back(seen.scan[i].cycle);
      EXPECT_TRUE(seen.scan[i].is_right) << seen.scan[i].radar << "/" << seen.scan[i].cycle << ": "
                                         << seen.scan[i].difference.data();
    }
    EXPECT_GT(sent.size(), 150u) << "the story was too short";
    EXPECT_EQ(delivered, sent) << "radar " << radar;
  }
}

void judge_service(const Seen& seen, const Stage& stage) {
  for (const std::uint32_t radar : {1u, 2u}) {
    const SeenScan* const end = seen.scan.data() + seen.scans;
    const SeenScan* const first = std::find_if(seen.scan.data(), end, [&](const SeenScan& scan) {
      return scan.radar == radar && scan.received_ns > stage.begin_ns;
    });
    ASSERT_NE(first, end) << stage.name << ": radar " << radar << " is not served";
    const double after_s = static_cast<double>(first->received_ns - stage.begin_ns) * 1e-9;
    EXPECT_LE(after_s, kOfferCycle_s + kLoadedMachine_s) << stage.name << ": radar " << radar;
    std::printf("%-24s radar %u is served %.2f s after its server started\n", stage.name.c_str(), radar, after_s);
  }
}

void judge_faults(const Seen& seen, const Stage& stage) {
  const SeenStatus& before = status_before(seen, stage.begin_ns);
  const SeenStatus& after = status_before(seen, stage.end_ns);
  const auto counted = [&](Fault kind) {
    return after.faults[static_cast<std::size_t>(kind)] - before.faults[static_cast<std::size_t>(kind)];
  };
  for (const Fault kind : kCounted) {
    const std::uint64_t expected = stage.faults[static_cast<std::size_t>(kind)];
    // In a storm the kernel may drop datagrams, which is reported.
    const bool may_lack = !stage.exact && counted(kind) < expected && counted(Fault::kLink) > 0;
    if (!may_lack) {
      EXPECT_EQ(counted(kind), expected) << stage.name << ": " << name_of(kind) << "; last " << after.last_fault.data();
    }
    if (expected > 0) {
      std::printf("%-24s %llu of %llu: %s\n", stage.name.c_str(), static_cast<unsigned long long>(counted(kind)),
                  static_cast<unsigned long long>(expected), std::string(name_of(kind)).c_str());
    }
  }
}

TEST_F(FaultyServerLive, GoodServersAreServedWhateverTheOthersDo) {
  const harness::Roudi roudi;
  const harness::Shared<Seen> seen;
  Child observer([&] { return observe(*seen); });
  const auto gateway =
      start({BORESIGHT_BINARY_DIR "/boresight-ingest_gateway", "--config", "/tmp/config", "--vehicle", "faulty_server"},
            "/tmp/gateway.log", false);
  ASSERT_TRUE(harness::eventually(10.0, [&] { return seen->attached && seen->statuses > 0; }))
      << text_of("/tmp/gateway.log");
  const auto story = start({"/usr/bin/python3", kRoom / "live/story.py", "/tmp/story.toml"}, "/tmp/story.log", true);
  const fs::path network = "/proc/" + std::to_string(story->pid()) + "/ns/net";
  ASSERT_TRUE(harness::eventually(5.0, [&] {
    std::error_code error;
    const fs::path its = fs::read_symlink(network, error);
    return !error && its != fs::read_symlink("/proc/self/ns/net");
  }));
  ASSERT_TRUE(run("ip link set server0 netns " + std::to_string(story->pid())));
  ASSERT_EQ(story->wait_for(90.0), 0) << text_of("/tmp/story.log");
  harness::sleep_s(0.3);
  EXPECT_EQ(gateway->wait_for(0.0), std::nullopt) << "the gateway ended: " << text_of("/tmp/gateway.log");
  const std::vector<Stage> stages = read_story("/tmp/story.toml");
  EXPECT_EQ(gateway->stop(), 0) << text_of("/tmp/gateway.log");
  EXPECT_EQ(observer.stop(), 0);

  ASSERT_GE(stages.size(), 10u);
  judge_scans(*seen, stages);
  for (const Stage& stage : stages) {
    if (stage.fresh) judge_service(*seen, stage);
    judge_faults(*seen, stage);
  }
  EXPECT_EQ(seen->status[seen->statuses - 1].heap_allocations, 0u);
  if (HasFailure()) std::printf("%s\n%s\n", text_of("/tmp/story.log").c_str(), text_of("/tmp/gateway.log").c_str());
}

}  // namespace
}  // namespace boresight::faulty_server
