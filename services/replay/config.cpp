#include "services/replay/config.hpp"

namespace boresight::replay {

Config read_config(config::Reader root) {
  Config c;
  c.tunnel_path = root.text("tunnel_path", "");
  for (config::Reader& route : root.tables("route")) {
    route.require("recorded");
    route.require("local");
    c.routes[route.text("recorded", "")] = route.text("local", "");
  }
  root.finish();
  return c;
}

}  // namespace boresight::replay
