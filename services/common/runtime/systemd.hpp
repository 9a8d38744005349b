// Notifications of a service of Type=notify to systemd; without effect outside systemd.
#pragma once

#include <cstdint>

namespace boresight::runtime::systemd {

void notify_ready();
void notify_stopping();
void stroke_watchdog();

}  // namespace boresight::runtime::systemd
