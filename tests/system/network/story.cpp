#include "tests/system/network/story.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <signal.h>

#include "services/common/runtime/clock.hpp"

namespace boresight::network {

namespace {

namespace fs = std::filesystem;

const std::string kGateway = std::string(BORESIGHT_BINARY_DIR) + "/boresight-ingest_gateway";
const std::string kReplay = std::string(BORESIGHT_BINARY_DIR) + "/boresight-replay";
const fs::path kConfig = "/tmp/config";

double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

}  // namespace

std::unique_ptr<Story::Shared> Story::shared_;

void Story::SetUpTestSuite() {
  if (shared_) return;
  fs::create_directories(kConfig / "vehicle");
  fs::copy(fs::path(BORESIGHT_SOURCE_DIR) / "config" / "services", kConfig / "services");
  setenv("BORESIGHT_RUNTIME_DIR", "/tmp/run", 1);
  shared_ = std::make_unique<Shared>();
}

void Story::TearDownTestSuite() {
  if (!shared_) return;
  EXPECT_TRUE(witness().stop());
  shared_.reset();
  fs::remove_all(kConfig);
}

void Story::SetUp() {
  first_scan_ = witness().size();
  write_vehicle(kEcuAddress, kGroupV4);
  offers_ = std::make_unique<Offers>(hosts(), kGroupV4);
}

void Story::TearDown() {
  stop_server();
  stop_gateway();
  std::size_t damaged = 0;
  for (std::size_t i = first_scan_; scans_are_synthetic_ && i < witness().size(); ++i) {
    damaged += witness()[i].is_as_sent ? 0 : 1;
  }
  EXPECT_EQ(damaged, 0u) << "scans differ from those of the server";
  EXPECT_EQ(witness().status().heap_allocations, 0u) << "on the gateway's data path";
  if (!HasFailure()) return;
  show_log(kGateway);
  show_log(kReplay);
}

void Story::write_vehicle_file(const std::string& content) {
  std::ofstream(kConfig / "vehicle" / "network.toml") << content;
}

void Story::write_vehicle(const std::string& address, const std::string& discovery_group) {
  std::string content = "name = \"network\"\n";
  const auto source = [&](int instance) {
    return "source = {link = \"someip\", address = \"" + address + "\", interface = \"" + kEcuInterface +
           "\", discovery_address = \"" + discovery_group + "\", instance = " + std::to_string(instance) + "}\n";
  };
  content += "[ego]\nprofile = \"boresight\"\n" + source(1);
  for (int id = 1; id <= 2; ++id) {
    content += "[[radar]]\nid = " + std::to_string(id) + "\nname = \"radar " + std::to_string(id) +
               "\"\nprofile = \"boresight\"\n" + source(id) + "mounting_pose = {position_m = [3.0, 0." +
               std::to_string(id) + ", 0.5], yaw_deg = 0.0}\n";
  }
  write_vehicle_file(content);
}

void Story::start_gateway() {
  const std::size_t statuses = witness().number_of_statuses();
  gateway_ = hosts().start(Host::kEcu, kGateway, {"--config", kConfig.string(), "--vehicle", "network"});
  ASSERT_TRUE(harness::eventually(10.0, [&] {
    return witness().number_of_statuses() > statuses && witness().status().state == ServiceState::kRunning;
  })) << "the gateway did not start";
}

void Story::stop_gateway() {
  if (!gateway_) return;
  EXPECT_EQ(gateway_->stop(), 0) << "the gateway's exit code";
  gateway_.reset();
}

std::unique_ptr<harness::Child> Story::start_replay(const std::vector<std::string>& options) {
  return hosts().start(Host::kSensors, kReplay, options);
}

void Story::start_server(const std::string& address, const std::vector<std::string>& options, unsigned detections) {
  std::vector<std::string> all{"--via",     "someip", "--interface", kServerInterface,
                               "--address", address,  "--radars",    "2",
                               "--rate",    "20",     "--synthetic", std::to_string(detections)};
  all.insert(all.end(), options.begin(), options.end());
  offers_->forget();
  server_ = start_replay(all);
}

void Story::kill_server() {
  server_->send(SIGKILL);
  ASSERT_EQ(server_->wait_for(5.0), -SIGKILL);
  server_.reset();
}

void Story::stop_server() {
  if (!server_) return;
  EXPECT_EQ(server_->stop(), 0) << "the server's exit code";
  server_.reset();
}

std::int64_t Story::wait_for_scans(std::int64_t since_ns, double seconds) {
  const SeenScan* first[2] = {};
  const bool came = harness::eventually(seconds, [&] {
    for (std::uint32_t radar = 1; radar <= 2; ++radar) first[radar - 1] = witness().first_since(since_ns, radar);
    return first[0] != nullptr && first[1] != nullptr;
  });
  if (came) return std::max(first[0]->received_ns, first[1]->received_ns);
  ADD_FAILURE() << "no scans of " << (first[0] == nullptr ? "radar 1 " : "") << (first[1] == nullptr ? "radar 2" : "");
  return 0;
}

void Story::expect_flow_after_offer(const std::string& what) {
  ASSERT_TRUE(harness::eventually(5.0, [&] { return offers_->first_ns().has_value(); })) << "the server does not offer";
  const std::int64_t offer_ns = *offers_->first_ns();
  const std::int64_t flow_ns = wait_for_scans(offer_ns, 3.0 * kOfferCycle_s);
  if (flow_ns == 0) return;
  std::printf("%-58s %6.1f ms after the first offer\n", what.c_str(), seconds(flow_ns - offer_ns) * 1e3);
  EXPECT_LT(seconds(flow_ns - offer_ns), kOfferCycle_s) << what;
}

void Story::expect_flow(const std::string& what, double limit_s) {
  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  const std::int64_t flow_ns = wait_for_scans(begin_ns, limit_s + 2.0);
  if (flow_ns == 0) return;
  std::printf("%-58s %6.1f ms\n", what.c_str(), seconds(flow_ns - begin_ns) * 1e3);
  EXPECT_LT(seconds(flow_ns - begin_ns), limit_s) << what;
}

bool Story::is_silent(double seconds) {
  const std::size_t before = witness().size();
  return !harness::eventually(seconds, [&] { return witness().size() != before; });
}

ServiceStatus Story::status_after_now() {
  const std::size_t before = witness().number_of_statuses();
  EXPECT_TRUE(harness::eventually(3.0, [&] { return witness().number_of_statuses() > before; }));
  return witness().status();
}

}  // namespace boresight::network
