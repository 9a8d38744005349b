// boresight-replay: plays recordings at link level, as if the sensors and buses were there.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/runtime_directory.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/config.hpp"
#include "services/replay/player.hpp"

using namespace boresight;

int main(int argc, char** argv) {
  replay::PlayOptions options;
  std::string config_directory;
  std::string speed = "1";
  std::string via = "tunnel";
  std::vector<std::string> routes;
  double wait_s = 30.0;
  bool check = false;

  CLI::App app{"Plays candump logs and pcap captures to the ingest gateway", "boresight-replay"};
  app.set_version_flag("--version", std::string("boresight-replay ") + BORESIGHT_VERSION);
  app.add_option("recordings", options.files, "recordings of one drive, merged by time stamp");
  app.add_option("--config", config_directory, "folder with services/replay.toml");
  app.add_flag("--check", check, "validate configuration and recordings' readability, and exit");
  app.add_option("--speed", speed, "factor to real time, or max")
      ->check(CLI::PositiveNumber | CLI::IsMember({"max"}))
      ->capture_default_str();
  app.add_option("--start", options.start_s, "seconds to skip")->check(CLI::Range(0.0, 1e9));
  app.add_option("--duration", options.duration_s, "seconds to play")->check(CLI::Range(0.0, 1e9));
  app.add_option("--step", options.step_s, "wait for Enter after each so many seconds of the recording")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option("--loop", options.loops, "times to play")->check(CLI::Range(1u, 1000000u));
  app.add_option("--via", via, "tunnel (the gateway's replay socket) or wire (UDP, SocketCAN)")
      ->check(CLI::IsMember({"tunnel", "wire"}))
      ->capture_default_str();
  app.add_option("--route", routes, "RECORDED=LOCAL: IPv4 address to use instead of a recorded one (wire)");
  app.add_option("--wait", wait_s, "seconds to wait for the gateway")->check(CLI::Range(0.0, 3600.0));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int kExitUsage = 2;
    return app.exit(error) == 0 ? EXIT_SUCCESS : kExitUsage;
  }

  runtime::log::initialise("boresight-replay");
  runtime::install_stop_signals();
  try {
    replay::Config config;
    if (!config_directory.empty()) {
      config = replay::read_config(config::Reader::open(config_directory + "/services/replay.toml"));
    }
    for (const std::string& route : routes) {
      const std::size_t equals = route.find('=');
      if (equals == std::string::npos) throw config::Error("--route " + route + ": must be RECORDED=LOCAL");
      config.routes[route.substr(0, equals)] = route.substr(equals + 1);
    }
    if (config.tunnel_path.empty()) config.tunnel_path = runtime::runtime_directory() + "/replay.sock";
    options.speed = speed == "max" ? 0.0 : std::stod(speed);
    if (options.speed < 0.0 || options.speed > 1000.0) throw config::Error("--speed: must be 0.01 … 1000 or max");
    if (check) {
      for (const auto& file : options.files) static_cast<void>(recording::open_recording(file, [](const auto&) {}));
      std::puts("boresight-replay: configuration is valid");
      return 0;
    }
    // Before any waiting: a recording that cannot be read is the user's first concern.
    static_cast<void>(recording::open_recordings(options.files, [](const auto&) {}));
    const auto sender = via == "wire" ? replay::make_wire_sender(config.routes)
                                      : replay::make_tunnel_sender(config.tunnel_path, wait_s);
    const replay::PlayResult result = replay::play(options, *sender);
    std::printf("replayed %.1f s: %llu frames sent, %llu lost, %llu malformed\n", result.recorded_s,
                static_cast<unsigned long long>(result.sent), static_cast<unsigned long long>(result.lost),
                static_cast<unsigned long long>(result.malformed));
    return 0;
  } catch (const config::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "boresight-replay: %s\n", error.what());
    return 1;
  }
}
