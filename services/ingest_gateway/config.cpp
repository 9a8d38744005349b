#include "services/ingest_gateway/config.hpp"

#include <cstdlib>

#include "services/common/runtime/config/network_values.hpp"
#include "services/common/runtime/runtime_directory.hpp"

namespace boresight::ingest {

std::string default_tunnel_path() {
  return runtime::runtime_directory() + "/replay.sock";
}

Config read_config(config::Reader root) {
  Config c;
  c.input = root.choice<Input>("input", {{"live", Input::kLive}, {"replay", Input::kReplay}}, c.input);
  c.tunnel_path = root.text("tunnel_path", "");
  if (c.tunnel_path.empty()) c.tunnel_path = default_tunnel_path();
  if (const auto problem = config::problem_of_socket_path(c.tunnel_path)) root.reject("tunnel_path", *problem);
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
