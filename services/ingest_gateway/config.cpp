#include "services/ingest_gateway/config.hpp"

#include <cstdlib>

#include "interfaces/messages/header.hpp"
#include "services/common/runtime/config/network_values.hpp"
#include "services/common/runtime/runtime_directory.hpp"

namespace boresight::ingest {

std::string default_tunnel_path() {
  return runtime::runtime_directory() + "/replay.sock";
}

ContradictionConfig read_contradiction(config::Reader table) {
  ContradictionConfig c;
  c.least_speed_mps = table.number("least_speed_mps", {1.0, 50.0}, c.least_speed_mps);
  c.fastest_reverse_mps = table.number("fastest_reverse_mps", {0.0, 50.0}, c.fastest_reverse_mps);
  c.scene_s = table.number("scene_s", {0.1, 60.0}, c.scene_s);
  c.seen_again = table.number("seen_again", {0.0, 0.95}, c.seen_again);
  c.false_alarm = table.number("false_alarm", {1e-12, 0.1}, c.false_alarm);
  c.false_return = table.number("false_return", {1e-12, 0.5}, c.false_return);
  c.memory_s = table.number("memory_s", {1.0, 3600.0}, c.memory_s);
  c.prior_s = table.number("prior_s", {0.1, 3600.0}, c.prior_s);
  c.sigma = table.number("sigma", {0.0, 10.0}, c.sigma);
  c.usual_share = table.number("usual_share", {0.01, 0.9}, c.usual_share);
  c.least_share = table.number("least_share", {0.01, c.usual_share}, c.least_share);
  c.few_detections = table.number("few_detections", {0.0, static_cast<double>(kMaxDetections)}, c.few_detections);
  return c;
}

Config read_config(config::Reader root) {
  Config c;
  c.input = root.choice<Input>("input", {{"live", Input::kLive}, {"replay", Input::kReplay}}, c.input);
  c.tunnel_path = root.text("tunnel_path", "");
  if (c.tunnel_path.empty()) c.tunnel_path = default_tunnel_path();
  if (const auto problem = config::problem_of_socket_path(c.tunnel_path)) root.reject("tunnel_path", *problem);
  c.contradiction = read_contradiction(root.table("contradiction"));
  root.finish();
  if (const char* const text = std::getenv("BORESIGHT_INPUT")) {
    const std::string word(text);
    if (word != "live" && word != "replay") {
      throw config::Error("$BORESIGHT_INPUT: \"" + word + "\" is unknown; must be one of \"live\", \"replay\"");
    }
    c.input = word == "live" ? Input::kLive : Input::kReplay;
  }
  return c;
}

}  // namespace boresight::ingest
