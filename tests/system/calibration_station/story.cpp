#include "tests/system/calibration_station/story.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include <signal.h>

namespace boresight::calibration_station {

namespace {

namespace fs = std::filesystem;
using alignment::station::test::measure_payload;
using alignment::station::test::start_payload;
using alignment::station::test::tilt_payload;

const std::string kEstimator = BORESIGHT_BINARY_DIR "/boresight-alignment_estimator";
const fs::path kConfig = "/tmp/config";
constexpr const char* kCapture = "/tmp/calibration.pcap";

/// GCC 12 has a false warning for concatenated strings.
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text.append(part);
  return text;
}

std::string content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Gives a key another value; the first one of that name at or after `from`.
void set(std::string& text, const std::string& from, const std::string& key, const std::string& value) {
  const std::size_t table = text.find(from);
  const std::size_t line = text.find(joined({"\n", key, " ="}), table);
  ASSERT_TRUE(table != std::string::npos && line != std::string::npos) << key;
  text.replace(line + 1, text.find('\n', line + 1) - line - 1, joined({key, " = ", value}));
}

bool is_installed(const std::string& program) {
  return std::system(joined({"command -v ", program, " >/dev/null"}).c_str()) == 0;
}

/// Output of a command.
std::string output_of(const std::string& command) {
  std::string output;
  FILE* const pipe = popen(command.c_str(), "r");
  for (int byte = std::fgetc(pipe); byte != EOF; byte = std::fgetc(pipe)) output.push_back(static_cast<char>(byte));
  pclose(pipe);
  return output;
}

}  // namespace

std::unique_ptr<Story::Shared> Story::shared_;

void Story::SetUpTestSuite() {
  if (shared_) return;
  fs::create_directories(kConfig / "vehicle");
  fs::copy(fs::path(BORESIGHT_SOURCE_DIR) / "config" / "services", kConfig / "services");
  std::ofstream vehicle(kConfig / "vehicle" / "calibration.toml");
  vehicle << "name = \"calibration\"\n[ego]\nprofile = \"toyota\"\nsource = {link = \"can\", interface = \"can0\"}\n";
  for (int id = 1; id <= 2; ++id) {
    vehicle << "[[radar]]\nid = " << id << "\nname = \"radar " << id << "\"\nprofile = \"ars408\"\nsensor_id = " << id
            << "\nsource = {link = \"can\", interface = \"can1\"}\n"
            << "mounting_pose = {position_m = [3.7, 0." << id << ", 0.5], yaw_deg = 0.0}\n";
  }
  vehicle.close();
  shared_ = std::make_unique<Shared>();
  if (is_installed("tcpdump")) {
    shared_->capture =
        shared_->hosts.start(network::Host::kSensors, "/usr/bin/tcpdump",
                             {"-i", network::kServerInterface, "-U", "-Z", "root", "-w", kCapture, "udp"});
    ASSERT_TRUE(harness::eventually(5.0, [] { return fs::exists(kCapture) && fs::file_size(kCapture) > 0; }));
  }
}

void Story::TearDownTestSuite() {
  if (!shared_) return;
  if (shared_->capture) {
    harness::sleep_s(0.3);
    EXPECT_TRUE(shared_->capture->stop().has_value());
    judge_capture();
  }
  EXPECT_TRUE(shared_->radars.stop());
  EXPECT_TRUE(shared_->reader.stop());
  shared_.reset();
  fs::remove_all(kConfig);
}

void Story::judge_capture() {
  if (!is_installed("tshark")) {
    std::puts("skipped: tshark is not installed");
    return;
  }
  // Severity: warning 6 and error 8, times 0x100000. The station sends some invalid messages on purpose.
  const std::string read = joined({"tshark -r ", kCapture, " -d udp.port==30490,someip -d udp.port==30700,someip",
                                   " -Y 'ip.src==", network::kEcuAddress});
  const auto count = [&read](const std::string& filter) {
    return std::strtol(output_of(joined({read, filter, "' 2>/dev/null | wc -l"})).c_str(), nullptr, 10);
  };
  const long frames = count(" && someip");
  const std::string fault = " && (_ws.malformed || _ws.expert.severity >= 6291456 || !someip) && !icmp";
  const long bad = count(fault);
  const long errors = count(" && someip.messagetype == 0x81");
  const long events = count(" && someip.messagetype == 0x02 && someip.serviceid == 0x4243");
  std::printf("tshark: %ld frames of the ECU, of these %ld errors and %ld events; %ld bad\n", frames, errors, events,
              bad);
  EXPECT_GT(frames, 200);
  EXPECT_GT(errors, 4);
  EXPECT_GT(events, 30);
  EXPECT_EQ(bad, 0) << output_of(joined({read, fault, "' -V 2>&1 | tail -40"}));
}

void Story::write_configuration(bool enabled) {
  const fs::path file = fs::path(BORESIGHT_SOURCE_DIR) / "config" / "services" / "alignment_estimator.toml";
  std::string text = content_of(file);
  if (enabled) {
    set(text, "[memory]", "path", "\"/tmp/memory/alignment\"");
    set(text, "[station]", "enabled", "true");
    set(text, "[station]", "interface", joined({"\"", network::kEcuInterface, "\""}));
    set(text, "[station]", "address", joined({"\"", network::kEcuAddress, "\""}));
    set(text, "[station]", "positioning_timeout_s", std::to_string(kPositioningTimeout_s));
    set(text, "[station]", "silence_timeout_s", std::to_string(kSilenceTimeout_s));
    set(text, "[station]", "settle_s", "0.05");
  }
  std::ofstream(kConfig / "services" / "alignment_estimator.toml") << text;
}

void Story::SetUp() {
  fs::remove_all("/tmp/memory");
  fs::create_directories("/tmp/memory");
  scene().tilt_rad = 0.0;
  scene().disturbance_db = 0.0;
  scene().speed_mps = 0.0;
  scene().yaw_rad = 0.6 * kDegree_rad;
  scene().pitch_rad = -0.9 * kDegree_rad;
  scene().is_plate_there = true;
  scene().has_maximum = true;
  write_configuration();
  start_estimator();
}

void Story::TearDown() {
  stop_estimator();
  EXPECT_EQ(reader().status().heap_allocations, 0u) << "on the data path";
  if (HasFailure()) network::show_log(kEstimator);
}

void Story::start_estimator() {
  const std::size_t statuses = reader().number_of_statuses();
  estimator_ =
      hosts().start(network::Host::kEcu, kEstimator, {"--config", kConfig.string(), "--vehicle", "calibration"});
  ASSERT_TRUE(harness::eventually(10.0, [&] {
    return reader().number_of_statuses() > statuses && reader().status().state == ServiceState::kRunning;
  })) << "the estimator did not start";
}

void Story::stop_estimator() {
  if (!estimator_) return;
  EXPECT_EQ(estimator_->stop(), 0) << "the estimator's exit code";
  estimator_.reset();
}

Station Story::station(std::uint16_t client) {
  return Station(hosts(), client, {recording::parse_ip(network::kEcuAddress).value(), service::kDefaultPort});
}

Answer Story::start(Station& station) {
  return station.ask(service::Method::kStartCalibration, start_payload(kRadarAtPlate, kTilts));
}

service::State Story::measure(Station& station, std::size_t index) {
  scene().tilt_rad = kTilts[index] * service::kRadiansPerUnitOfTilt;
  const Answer begun =
      station.ask(service::Method::kMeasure, measure_payload(static_cast<std::uint16_t>(index), kTilts[index]));
  EXPECT_EQ(begun.refusal(), service::Refusal::kNone) << "tilt " << index;
  service::State state{};
  static_cast<void>(harness::eventually(5.0, [&] {
    state = station.state().state(0);
    return state != service::State::kMeasuring;
  }));
  return state;
}

Answer Story::finish(Station& station, std::size_t first) {
  Answer verdict;
  for (std::size_t i = first; i < kTilts.size(); ++i) {
    EXPECT_EQ(measure(station, i), service::State::kTiltDone) << "tilt " << i;
    verdict = station.ask(service::Method::kNext, tilt_payload(static_cast<std::uint16_t>(i)));
    EXPECT_EQ(verdict.refusal(), service::Refusal::kNone) << "tilt " << i;
  }
  return verdict;
}

void Story::expect_truth(const Answer& result) {
  ASSERT_EQ(result.code(), service::ReturnCode::kOk);
  EXPECT_EQ(result.u8(service::result::kFailure), 0);
  EXPECT_NEAR(result.f32(service::result::kYaw_rad), scene().yaw_rad, 0.05 * kDegree_rad);
  EXPECT_NEAR(result.f32(service::result::kPitch_rad), scene().pitch_rad, 0.1 * kDegree_rad);
  EXPECT_EQ(result.u16(service::result::kNumberOfTilts), kTilts.size());
}

ServiceStatus Story::status_after_now() {
  const std::size_t before = reader().number_of_statuses();
  EXPECT_TRUE(harness::eventually(3.0, [&] { return reader().number_of_statuses() > before + 1; }));
  return reader().status();
}

}  // namespace boresight::calibration_station
