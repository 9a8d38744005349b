// The virtual network of on_wire, and the kernel's counters in it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "services/common/recording/ip_address.hpp"

namespace boresight::bench {

inline constexpr std::uint32_t kRadars = 8;
inline constexpr std::uint32_t kDetections = 800;
inline constexpr double kRate_hz = 20.0;

inline constexpr recording::Endpoint kArs548Group{recording::IpAddress::v4(0xE0000202), 42102};
inline constexpr std::uint32_t kFirstArs548Address = 0x0A0D0101;  // 10.13.1.1
inline constexpr recording::Endpoint kEgoServer{recording::IpAddress::v4(0x0A0D0201), 30700};
inline constexpr recording::Endpoint kEcuEvents{recording::IpAddress::v4(0x0A0D0001), 30600};

/// True if on_wire has prepared the network.
[[nodiscard]] bool has_network();
/// Moves the calling single-threaded process to the radars' side. Throws std::runtime_error.
void enter_radars_network();

/// Datagrams dropped by the kernel since the network was created: full receive buffers, failed fragment reassembly.
[[nodiscard]] std::uint64_t kernel_drops();

/// Processor time that a process has used, in user and system mode.
[[nodiscard]] double cpu_time_s(int pid);

/// Writes a configuration with two vehicles of eight radars each, "ars548" and "someip"; returns its folder.
[[nodiscard]] std::string write_configuration();

}  // namespace boresight::bench
