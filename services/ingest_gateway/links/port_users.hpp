// Finds other programs of this host with the same UDP port, from the kernel's tables.
#pragma once

#include <cstdint>
#include <istream>

#include <sys/types.h>

#include "services/common/recording/ip_address.hpp"

namespace boresight::ingest {

/// True if a table in the form of /proc/net/udp or /proc/net/udp6 has a socket with this address and port, or with all
/// addresses and this port, other than that of inode `own`. Invalid lines are skipped.
[[nodiscard]] bool has_other_user(std::istream& table, const recording::Endpoint& local, ino_t own);

/// The same for the tables of this host. False if they cannot be read. "All addresses" of IPv6 does not include IPv4.
[[nodiscard]] bool has_other_user(const recording::Endpoint& local, ino_t own);

}  // namespace boresight::ingest
