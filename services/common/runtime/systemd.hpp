// What systemd wants to hear from a service of Type=notify; without effect outside systemd.
#pragma once

#include <cstdint>

namespace boresight::runtime::systemd {

void notify_ready();
void notify_stopping();
void stroke_watchdog();

}  // namespace boresight::runtime::systemd
