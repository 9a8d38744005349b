// Which other programs of this host have a UDP port, as the kernel's tables say.
#pragma once

#include <cstdint>
#include <istream>

#include <sys/types.h>

#include "services/common/recording/ip_address.hpp"

namespace boresight::ingest {

/// Whether a table in the form of /proc/net/udp or /proc/net/udp6 holds a socket other than that of inode `own` which
/// has this address and port, or all addresses and this port. Lines that cannot be read are passed over.
[[nodiscard]] bool has_other_user(std::istream& table, const recording::Endpoint& local, ino_t own);

/// The same for the tables of this host. False if they cannot be read. All addresses of IPv6 are not taken for those
/// of IPv4, too.
[[nodiscard]] bool has_other_user(const recording::Endpoint& local, ino_t own);

}  // namespace boresight::ingest
