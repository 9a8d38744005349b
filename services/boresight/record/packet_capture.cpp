#include "services/boresight/record/packet_capture.hpp"

#include <array>
#include <cstring>
#include <stdexcept>

#include <net/if.h>
#include <netinet/in.h>
#include <pcap/pcap.h>

#include "services/boresight/record/capture_error.hpp"

namespace boresight::record {

namespace {

// Larger than any IP packet with its link layer; a packet takes only its own length in the buffer.
constexpr int kSnapshotLength = 262144;
constexpr int kBuffer_bytes = 64 * 1024 * 1024;
constexpr int kTimeout_ms = 100;
constexpr int kPacketsPerTurn = 1000;

/// A socket whose only purpose is this host's membership in the group on the interface.
ingest::Socket join(const recording::IpAddress& group, const std::string& interface) {
  const auto index = interface == "any" ? 0u : if_nametoindex(interface.c_str());
  ingest::Socket made(socket(group.is_v4() ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  int result = -1;
  if (group.is_v4()) {
    ip_mreqn request{};
    request.imr_multiaddr.s_addr = htonl(group.to_v4());
    request.imr_ifindex = static_cast<int>(index);
    result = setsockopt(made.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof(request));
  } else {
    ipv6_mreq request{};
    std::memcpy(&request.ipv6mr_multiaddr, group.bytes.data(), group.bytes.size());
    request.ipv6mr_interface = index;
    result = setsockopt(made.get(), IPPROTO_IPV6, IPV6_ADD_MEMBERSHIP, &request, sizeof(request));
  }
  // For "any", the kernel has to choose an interface, and there may be no route.
  if (result != 0 && interface != "any") {
    throw CaptureError(interface + ": cannot join " + recording::to_text(group) + ": " + ingest::last_error());
  }
  return made;
}

}  // namespace

PacketCapture::PacketCapture(PacketSource source) : source_(std::move(source)) {
  open();
}

PacketCapture::~PacketCapture() {
  close();
}

void PacketCapture::open() {
  const std::string& interface = source_.interface;
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_ = pcap_create(interface.c_str(), error.data());
  if (pcap_ == nullptr) throw CaptureError(interface + ": " + error.data());
  pcap_set_snaplen(pcap_, kSnapshotLength);
  pcap_set_promisc(pcap_, 1);
  pcap_set_timeout(pcap_, kTimeout_ms);
  pcap_set_buffer_size(pcap_, kBuffer_bytes);
  nanoseconds_ = pcap_set_tstamp_precision(pcap_, PCAP_TSTAMP_PRECISION_NANO) == 0;
  const int status = pcap_activate(pcap_);
  if (status < 0) {
    std::string cause = status == PCAP_ERROR_NO_SUCH_DEVICE ? "no such interface" : pcap_statustostr(status);
    if (status == PCAP_ERROR_PERM_DENIED || status == PCAP_ERROR_PROMISC_PERM_DENIED) {
      cause = "not permitted; run as root or with the capability CAP_NET_RAW";
    } else if (status == PCAP_ERROR && *pcap_geterr(pcap_) != '\0') {
      cause = pcap_geterr(pcap_);
    }
    close();
    throw CaptureError(interface + ": " + cause);
  }
  link_type_ = pcap_datalink(pcap_);
  bpf_program program{};
  if (pcap_compile(pcap_, &program, source_.filter.c_str(), 1, PCAP_NETMASK_UNKNOWN) != 0) {
    const std::string cause = pcap_geterr(pcap_);
    close();
    throw std::invalid_argument(interface + ": filter \"" + source_.filter + "\": " + cause);
  }
  const bool filtered = pcap_setfilter(pcap_, &program) == 0;
  pcap_freecode(&program);
  if (!filtered || pcap_setnonblock(pcap_, 1, error.data()) != 0) {
    const std::string cause = filtered ? error.data() : pcap_geterr(pcap_);
    close();
    throw CaptureError(interface + ": " + cause);
  }
  memberships_.clear();
  for (const recording::IpAddress& group : source_.multicast) memberships_.push_back(join(group, interface));
}

void PacketCapture::close() {
  dropped_before_ = dropped();
  if (pcap_ != nullptr) pcap_close(pcap_);
  pcap_ = nullptr;
}

void PacketCapture::reopen() {
  const int link_type = link_type_;
  try {
    open();
  } catch (const CaptureError&) {
    close();  // it is tried again; the loss of the interface was already reported
    return;
  }
  // A file has one link type, so an interface that returns with another one cannot be recorded into it.
  if (link_type_ != link_type) {
    link_type_ = link_type;
    close();
  }
}

std::unique_ptr<recording::PcapWriter> PacketCapture::make_writer(const std::filesystem::path& file) const {
  return std::make_unique<recording::PcapWriter>(file, link_type_, kSnapshotLength);
}

int PacketCapture::descriptor() const {
  return pcap_ == nullptr ? -1 : pcap_get_selectable_fd(pcap_);
}

void PacketCapture::read(recording::PcapWriter& writer, std::string& problem) {
  problem.clear();
  for (int i = 0; i < kPacketsPerTurn; ++i) {
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    const int status = pcap_next_ex(pcap_, &header, &bytes);
    if (status == 0) return;
    if (status < 0) {
      problem = interface() + ": " + pcap_geterr(pcap_);
      close();
      return;
    }
    const std::int64_t fraction_ns = static_cast<std::int64_t>(header->ts.tv_usec) * (nanoseconds_ ? 1 : 1000);
    writer.write(static_cast<std::int64_t>(header->ts.tv_sec) * 1'000'000'000 + fraction_ns, {bytes, header->caplen},
                 header->len);
    ++packets_;
  }
}

std::uint64_t PacketCapture::dropped() const {
  pcap_stat statistics{};
  if (pcap_ == nullptr || pcap_stats(pcap_, &statistics) != 0) return dropped_before_;
  return dropped_before_ + statistics.ps_drop + statistics.ps_ifdrop;
}

}  // namespace boresight::record
