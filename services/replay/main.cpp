// boresight-replay: sends recorded frames in place of sensors and buses.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/exit_codes.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/options.hpp"
#include "services/common/runtime/runtime_directory.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/config.hpp"
#include "services/replay/player.hpp"
#include "services/replay/senders/following_sender.hpp"
#include "services/replay/server/command.hpp"

using namespace boresight;

namespace {

struct CommandLine {
  replay::PlayOptions play;
  runtime::Configuration configuration;
  bool has_config_folder = false;  // --config was given
  std::string speed = "1";
  std::string via = "tunnel";
  std::vector<std::string> routes;
  double wait_s = 30.0;
  bool check = false;
  replay::SomeIpCommand someip;
};

void add_options(CLI::App& app, CommandLine& line) {
  app.set_version_flag("--version", std::string("boresight-replay ") + BORESIGHT_VERSION);
  app.add_option("recordings", line.play.files, "Recordings of one drive, merged by time stamp")->type_name("FILE");
  runtime::add_config_option(app, line.configuration);
  runtime::add_vehicle_option(app, line.configuration,
                              "Vehicle of the recordings (someip): a name in the folder vehicle/, or a file");
  app.add_flag("--check", line.check, "Checks the configuration and opens the recordings, then ends");
  app.add_option("--speed", line.speed, "Factor on the recorded speed, or max: as fast as the pipeline takes the scans")
      ->check(CLI::PositiveNumber | CLI::IsMember({"max"}))
      ->type_name("FACTOR")
      ->capture_default_str();
  app.add_option("--start", line.play.start_s, "Seconds to skip at the beginning")
      ->check(CLI::Range(0.0, 1e9))
      ->type_name("S");
  app.add_option("--duration", line.play.duration_s, "Seconds to play")->check(CLI::Range(0.0, 1e9))->type_name("S");
  app.add_option("--step", line.play.step_s, "Waits for Enter after each step of this many seconds")
      ->check(CLI::Range(0.001, 1e6))
      ->type_name("S");
  app.add_option("--loop", line.play.loops, "Number of times to play")->check(CLI::Range(1u, 1000000u))->type_name("N");
  app.add_option("--via", line.via,
                 "tunnel: to the gateway's replay socket; wire: by UDP and SocketCAN; someip: as a server of the "
                 "Boresight service")
      ->check(CLI::IsMember({"tunnel", "wire", "someip"}))
      ->type_name("tunnel|wire|someip")
      ->capture_default_str();
  app.add_option("--route", line.routes, "Local IPv4 address in place of a recorded one (wire); repeatable")
      ->type_name("RECORDED=LOCAL");
  app.add_option("--wait", line.wait_s, "Seconds to wait for the gateway, or for the first subscriber (someip)")
      ->check(CLI::Range(0.0, 3600.0))
      ->type_name("S")
      ->capture_default_str();
  replay::add_someip_options(app, line.someip);
  app.footer(
      "Exit codes: 0 played to the end, or stopped by a signal; 1 with --speed max, the pipeline lost "
      "scans; 2 wrong command line or configuration; 3 a recording cannot be read, or the gateway or network cannot be "
      "reached");
}

replay::Config read_config(const CommandLine& line) {
  replay::Config config;
  const std::filesystem::path file = line.configuration.service_file("replay");
  if (line.has_config_folder || std::filesystem::exists(file)) {
    config = replay::read_config(config::Reader::open(file));
  }
  for (const std::string& route : line.routes) {
    const std::size_t equals = route.find('=');
    if (equals == std::string::npos) throw config::Error("--route " + route + ": must be RECORDED=LOCAL");
    config.routes[route.substr(0, equals)] = route.substr(equals + 1);
  }
  if (config.tunnel_path.empty()) config.tunnel_path = runtime::runtime_directory() + "/replay.sock";
  return config;
}

void print(const replay::PlayResult& result) {
  std::printf("replayed %.1f s: %llu frames sent, %llu lost, %llu malformed\n", result.recorded_s,
              static_cast<unsigned long long>(result.sent), static_cast<unsigned long long>(result.lost),
              static_cast<unsigned long long>(result.malformed));
}

/// Plays as fast as the pipeline takes the scans; returns the exit code.
int play_following(const CommandLine& line, const replay::Config& config, std::unique_ptr<replay::Sender> tunnel) {
  replay::FollowingSender sender(std::move(tunnel), config.max_speed);
  const replay::PlayResult result = replay::play(line.play, sender);
  sender.finish();
  print(result);
  std::fputs(sender.text().c_str(), stdout);
  return sender.has_losses() && !result.stopped ? exit_code::kFinding : exit_code::kSuccess;
}

int play_frames(const CommandLine& line, const replay::Config& config) {
  auto sender = line.via == "wire" ? replay::make_wire_sender(config.routes)
                                   : replay::make_tunnel_sender(config.tunnel_path, line.wait_s);
  if (line.via == "tunnel" && line.play.speed <= 0.0) {
    if (runtime::Node::roudi_is_reachable()) return play_following(line, config, std::move(sender));
    runtime::log::warning("RouDi cannot be reached: lost scans are neither avoided nor counted");
  }
  print(replay::play(line.play, *sender));
  return exit_code::kSuccess;
}

int run(CommandLine& line) {
  const replay::Config config = read_config(line);
  line.play.speed = line.speed == "max" ? 0.0 : std::stod(line.speed);
  if (line.play.speed < 0.0 || line.play.speed > 1000.0) throw config::Error("--speed: must be 0.01 … 1000 or max");
  if (line.check) {
    for (const auto& file : line.play.files) static_cast<void>(recording::open_recording(file, [](const auto&) {}));
    std::puts("boresight-replay: configuration is valid");
    return exit_code::kSuccess;
  }
  const bool synthetic = line.someip.synthetic.detections > 0;
  if (synthetic && line.via != "someip") throw config::Error("--synthetic: only with --via someip");
  if (!synthetic && line.play.files.empty()) throw config::Error("no recording given; see --help");
  // Opens the recordings before any waiting, so that an error is reported at once.
  if (!synthetic) static_cast<void>(recording::open_recordings(line.play.files, [](const auto&) {}));
  if (line.via != "someip") return play_frames(line, config);
  std::optional<VehicleConfig> vehicle;
  if (!synthetic || !line.configuration.vehicle_name.empty()) vehicle = line.configuration.vehicle();
  replay::serve_someip(line.someip, config.someip, vehicle ? &*vehicle : nullptr, line.play, line.wait_s);
  return exit_code::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line;
  CLI::App app{"Sends the frames of candump logs and pcap captures to the ingest gateway", "boresight-replay"};
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_code::kSuccess : exit_code::kUsage;
  }
  line.has_config_folder = app.count("--config") > 0;

  runtime::log::initialise("boresight-replay");
  runtime::install_stop_signals();
  try {
    return run(line);
  } catch (const config::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return exit_code::kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "boresight-replay: %s\n", error.what());
    return exit_code::kInputOutput;
  }
}
