// boresight-replay: plays recordings at link level, as if the sensors and buses were there.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/options.hpp"
#include "services/common/runtime/runtime_directory.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/config.hpp"
#include "services/replay/player.hpp"
#include "services/replay/server/command.hpp"

using namespace boresight;

namespace {

struct CommandLine {
  replay::PlayOptions play;
  std::string config_directory;
  std::string vehicle;
  std::string speed = "1";
  std::string via = "tunnel";
  std::vector<std::string> routes;
  double wait_s = 30.0;
  bool check = false;
  replay::SomeIpCommand someip;
};

void add_options(CLI::App& app, CommandLine& line) {
  app.set_version_flag("--version", std::string("boresight-replay ") + BORESIGHT_VERSION);
  app.add_option("recordings", line.play.files, "recordings of one drive, merged by time stamp");
  app.add_option("--config", line.config_directory, "folder with services/replay.toml and vehicle/");
  app.add_option("--vehicle", line.vehicle, "name of the file in vehicle/ (someip); default: the only one");
  app.add_flag("--check", line.check, "validate configuration and recordings' readability, and exit");
  app.add_option("--speed", line.speed, "factor to real time, or max")
      ->check(CLI::PositiveNumber | CLI::IsMember({"max"}))
      ->capture_default_str();
  app.add_option("--start", line.play.start_s, "seconds to skip")->check(CLI::Range(0.0, 1e9));
  app.add_option("--duration", line.play.duration_s, "seconds to play")->check(CLI::Range(0.0, 1e9));
  app.add_option("--step", line.play.step_s, "wait for Enter after each so many seconds of the recording")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option("--loop", line.play.loops, "times to play")->check(CLI::Range(1u, 1000000u));
  app.add_option("--via", line.via,
                 "tunnel (the gateway's replay socket), wire (UDP, SocketCAN) or someip (as a server of the Boresight "
                 "service)")
      ->check(CLI::IsMember({"tunnel", "wire", "someip"}))
      ->capture_default_str();
  app.add_option("--route", line.routes, "RECORDED=LOCAL: IPv4 address to use instead of a recorded one (wire)");
  app.add_option("--wait", line.wait_s, "seconds to wait for the gateway")->check(CLI::Range(0.0, 3600.0));
  replay::add_someip_options(app, line.someip);
}

replay::Config read_config(const CommandLine& line) {
  replay::Config config;
  if (!line.config_directory.empty()) {
    config = replay::read_config(config::Reader::open(line.config_directory + "/services/replay.toml"));
  }
  for (const std::string& route : line.routes) {
    const std::size_t equals = route.find('=');
    if (equals == std::string::npos) throw config::Error("--route " + route + ": must be RECORDED=LOCAL");
    config.routes[route.substr(0, equals)] = route.substr(equals + 1);
  }
  if (config.tunnel_path.empty()) config.tunnel_path = runtime::runtime_directory() + "/replay.sock";
  return config;
}

void play_frames(const CommandLine& line, const replay::Config& config) {
  const auto sender = line.via == "wire" ? replay::make_wire_sender(config.routes)
                                         : replay::make_tunnel_sender(config.tunnel_path, line.wait_s);
  const replay::PlayResult result = replay::play(line.play, *sender);
  std::printf("replayed %.1f s: %llu frames sent, %llu lost, %llu malformed\n", result.recorded_s,
              static_cast<unsigned long long>(result.sent), static_cast<unsigned long long>(result.lost),
              static_cast<unsigned long long>(result.malformed));
}

void run(CommandLine& line) {
  const replay::Config config = read_config(line);
  line.play.speed = line.speed == "max" ? 0.0 : std::stod(line.speed);
  if (line.play.speed < 0.0 || line.play.speed > 1000.0) throw config::Error("--speed: must be 0.01 … 1000 or max");
  if (line.check) {
    for (const auto& file : line.play.files) static_cast<void>(recording::open_recording(file, [](const auto&) {}));
    std::puts("boresight-replay: configuration is valid");
    return;
  }
  const bool synthetic = line.someip.synthetic.detections > 0;
  if (synthetic && line.via != "someip") throw config::Error("--synthetic: only with --via someip");
  // Before any waiting: a recording that cannot be read is the user's first concern.
  if (!synthetic) static_cast<void>(recording::open_recordings(line.play.files, [](const auto&) {}));
  if (line.via != "someip") {
    play_frames(line, config);
    return;
  }
  std::optional<VehicleConfig> vehicle;
  // Synthetic radars need none; recordings without one are refused where the command line is checked.
  if (!line.config_directory.empty() && !(synthetic && line.vehicle.empty())) {
    vehicle = runtime::Configuration{line.config_directory, line.vehicle}.vehicle();
  }
  replay::serve_someip(line.someip, config.someip, vehicle ? &*vehicle : nullptr, line.play, line.wait_s);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line;
  CLI::App app{"Plays candump logs and pcap captures to the ingest gateway", "boresight-replay"};
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int kExitUsage = 2;
    return app.exit(error) == 0 ? EXIT_SUCCESS : kExitUsage;
  }

  runtime::log::initialise("boresight-replay");
  runtime::install_stop_signals();
  try {
    run(line);
    return 0;
  } catch (const config::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "boresight-replay: %s\n", error.what());
    return 1;
  }
}
