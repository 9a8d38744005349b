#include "services/boresight/record/capture_plan.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <pcap/pcap.h>

#include "services/boresight/record/capture_error.hpp"
#include "services/boresight/record/recorder.hpp"
#include "tests/unit/recording/capture_files.hpp"

namespace boresight::record {
namespace {

using recording::append_number;

VehicleConfig vehicle() {
  VehicleConfig vehicle;
  const auto source = [](LinkKind link, const char* interface, const char* address, int port, const char* sender) {
    SourceAddress made;
    made.link = link;
    made.interface = interface;
    made.address = address;
    made.port = static_cast<std::uint16_t>(port);
    made.sender = sender;
    return made;
  };
  vehicle.ego.source = source(LinkKind::kCan, "can0", "", 0, "");
  vehicle.radars.resize(5);
  vehicle.radars[0].source = source(LinkKind::kCan, "can1", "", 0, "");
  vehicle.radars[1].source = source(LinkKind::kCan, "can0", "", 0, "");
  vehicle.radars[2].source = source(LinkKind::kUdp, "eth0", "224.0.2.2", 42102, "10.13.1.113");
  vehicle.radars[3].source = source(LinkKind::kUdp, "eth0", "224.0.2.2", 42102, "10.13.1.114");
  vehicle.radars[4].source = source(LinkKind::kUdp, "eth0", "ff05::2", 42103, "");
  return vehicle;
}

/// A filter as the kernel would apply it to Ethernet.
class Filter {
 public:
  explicit Filter(const std::string& text) : pcap_(pcap_open_dead(DLT_EN10MB, 65535)) {
    valid_ = pcap_compile(pcap_, &program_, text.c_str(), 1, PCAP_NETMASK_UNKNOWN) == 0;
    EXPECT_TRUE(valid_) << text << ": " << pcap_geterr(pcap_);
  }
  ~Filter() {
    if (valid_) pcap_freecode(&program_);
    pcap_close(pcap_);
  }
  bool takes(const std::string& packet) const {
    pcap_pkthdr header{};
    header.caplen = header.len = static_cast<bpf_u_int32>(packet.size());
    return pcap_offline_filter(&program_, &header, reinterpret_cast<const u_char*>(packet.data())) != 0;
  }

 private:
  pcap_t* pcap_;
  bpf_program program_{};
  bool valid_ = false;
};

std::string ethernet(std::uint16_t type, const std::string& rest, bool tagged = false) {
  std::string packet(12, '\1');
  if (tagged) append_number(packet, 0x81000007, 4, true);
  append_number(packet, type, 2, true);
  return packet + rest;
}

std::string ipv4(std::uint32_t source, std::uint32_t destination, std::uint16_t port, std::uint16_t fragment = 0) {
  std::string packet = recording::udp_packet("some data");
  std::string addresses, ports, field;
  append_number(addresses, source, 4, true);
  append_number(addresses, destination, 4, true);
  append_number(ports, port, 2, true);
  append_number(field, fragment, 2, true);
  packet.replace(12, 8, addresses);
  packet.replace(22, 2, ports);
  packet.replace(6, 2, field);
  return packet;
}

TEST(CapturePlan, EachInterfaceOnceAndTheVehiclesMulticastGroups) {
  const CapturePlan plan = plan_of(vehicle());
  EXPECT_THAT(plan.can, testing::ElementsAre("can0", "can1"));
  ASSERT_EQ(plan.packets.size(), 1u);
  EXPECT_EQ(plan.packets[0].interface, "eth0");
  EXPECT_THAT(plan.packets[0].multicast,
              testing::ElementsAre(*recording::parse_ip("224.0.2.2"), *recording::parse_ip("ff05::2")));
}

TEST(CapturePlan, TheFilterTakesEveryFragmentOfTheRadarsAndNothingElse) {
  const Filter filter(plan_of(vehicle()).packets.at(0).filter);
  constexpr std::uint32_t kRadar = 0x0A0D0171, kOther = 0x0A0D0180, kGroup = 0xE0000202;
  for (const bool tagged : {false, true}) {
    EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(kRadar, kGroup, 42102), tagged))) << tagged;
    EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(kRadar, kGroup, 42102, 0x2000), tagged))) << "first fragment";
    EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(kRadar, kGroup, 7, 0x20B9), tagged))) << "a later one";
    EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(kRadar, kGroup, 7, 0x00B9), tagged))) << "the last one";
    EXPECT_FALSE(filter.takes(ethernet(0x0800, ipv4(kOther, kGroup, 42102), tagged))) << "another sender";
    EXPECT_FALSE(filter.takes(ethernet(0x0800, ipv4(kRadar, kGroup, 7), tagged))) << "another port";
    EXPECT_FALSE(filter.takes(ethernet(0x0800, ipv4(kRadar, 0xE0000203, 42102), tagged))) << "another group";
    EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(kOther, kOther, 30490), tagged))) << "service discovery";
    EXPECT_FALSE(filter.takes(ethernet(0x0806, std::string(40, '\0'), tagged))) << "ARP";
    std::string v6 = recording::udp_packet("data", true);
    std::string group;
    append_number(group, 0xFF05000000000000, 8, true);
    append_number(group, 2, 8, true);
    v6.replace(24, 16, group);
    EXPECT_FALSE(filter.takes(ethernet(0x86DD, v6, tagged))) << "another port";
    std::string port;
    append_number(port, 42103, 2, true);
    EXPECT_TRUE(filter.takes(ethernet(0x86DD, std::string(v6).replace(42, 2, port), tagged)));
    EXPECT_TRUE(filter.takes(ethernet(0x86DD, std::string(v6).replace(6, 1, "\x2C"), tagged))) << "fragment";
  }
}

TEST(CapturePlan, OfSomeIpAllThatMayBeAnEventIsTaken) {
  VehicleConfig one = vehicle();
  one.radars.resize(1);
  one.radars[0].source.link = LinkKind::kSomeIp;
  one.radars[0].source.interface = "eth1";
  one.radars[0].source.address = "10.0.0.2";
  one.radars[0].source.port = 30600;
  const CapturePlan plan = plan_of(one);
  ASSERT_EQ(plan.packets.size(), 1u);
  EXPECT_THAT(plan.packets[0].multicast, testing::ElementsAre(*recording::parse_ip("224.244.224.245")));
  const Filter filter(plan.packets[0].filter);
  EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(0x0A000001, 0x0A000002, 30600))));
  EXPECT_TRUE(filter.takes(ethernet(0x0800, ipv4(0x0A000001, 0xEF000001, 5000)))) << "a group that the server chose";
  EXPECT_FALSE(filter.takes(ethernet(0x0800, ipv4(0x0A000001, 0x0A000003, 30600)))) << "another ECU";
}

TEST(OutputFiles, OneFileOrAFolderAndNothingIsOverwritten) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("boresight_record_" + std::to_string(getpid()));
  const CapturePlan can{{"can0", "can1"}, {}}, network{{}, {{"eth0", "", {}}}}, both{{"can0"}, network.packets};
  const auto& name = name_files;
  EXPECT_EQ(name(can, folder / "a.log", "T").can, folder / "a.log");
  EXPECT_EQ(name(network, folder / "a.pcap", "T").packets.at(0), folder / "a.pcap");
  EXPECT_THROW(static_cast<void>(name(can, folder / "a.pcap", "T")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(name(network, folder / "a.log", "T")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(name(both, folder / "a.pcap", "T")), std::invalid_argument);
  const OutputFiles files = name(both, folder, "20261121T080000Z");
  EXPECT_EQ(files.can, folder / "boresight-20261121T080000Z.log");
  EXPECT_EQ(files.packets.at(0), folder / "boresight-20261121T080000Z-eth0.pcap");
  recording::CandumpWriter writer(files.can);
  EXPECT_THROW(static_cast<void>(name(both, folder, "20261121T080000Z")), CaptureError);
  EXPECT_THROW(static_cast<void>(name(can, "/proc/absent", "T")), CaptureError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace boresight::record
