// Notifications of a service to its manager, systemd or `boresight supervise`, by the datagram socket $NOTIFY_SOCKET.
// Without effect if that is not set.
#pragma once

namespace boresight::runtime::systemd {

void notify_ready();
void notify_stopping();
/// Never waits: if the manager stands still and its queue is full, the stroke is lost and the data flow goes on.
void stroke_watchdog();

}  // namespace boresight::runtime::systemd
