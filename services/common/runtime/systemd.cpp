#include "services/common/runtime/systemd.hpp"

#include <systemd/sd-daemon.h>

namespace boresight::runtime::systemd {

void notify_ready() {
  sd_notify(0, "READY=1");
}
void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}
void stroke_watchdog() {
  sd_notify(0, "WATCHDOG=1");
}

}  // namespace boresight::runtime::systemd
