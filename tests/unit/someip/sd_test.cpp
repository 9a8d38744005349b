// Service discovery messages. The hexadecimal ones were made by scapy 2.5 (scapy.contrib.automotive.someip).
#include "services/ingest_gateway/codecs/someip/sd.hpp"

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/ingest_gateway/codecs/someip/sd_writer.hpp"
#include "tests/unit/someip/sd_bytes.hpp"

namespace boresight::ingest::someip {
namespace {

using recording::Endpoint;
using recording::IpAddress;
using test::Bytes;
using test::endpoint;
using test::from_hex;
using test::ipv4_option;
using Family = SdMessage::Family;
using Purpose = SdMessage::Purpose;

const std::array<std::uint8_t, 16> kServer6{0xFD, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x20};

class SdTest : public testing::Test {
 protected:
  SdFault read(const Bytes& datagram) {
    datagram_ = datagram;
    MessageReader reader(datagram_);
    Message message;
    if (reader.next(message) != ReadResult::kMessage) ADD_FAILURE() << "no SOME/IP message";
    return sd_.read(message);
  }
  SdFault read_sd(const test::Sd& sd) { return read(test::sd_datagram(sd)); }
  /// Fault of the unicast endpoint of a lone offer with these options.
  SdFault offer_fault(const std::vector<Bytes>& options) {
    EXPECT_EQ(read_sd({.entries = {{.number_1 = static_cast<std::uint8_t>(options.size())}}, .options = options}),
              SdFault::kNone);
    if (sd_.entries()[0].fault != SdFault::kNone) return sd_.entries()[0].fault;
    return sd_.endpoint_of(sd_.entries()[0], Family::kIpv4, Purpose::kUnicast, endpoint_);
  }
  /// Bytes of an invalid payload.
  SdFault read_payload(const Bytes& payload) { return read(test::message(test::kSdHeader, payload)); }

  Bytes datagram_;
  SdMessage sd_;
  Endpoint endpoint_;
};

TEST_F(SdTest, ReadsAnOfferOfScapy) {
  ASSERT_EQ(
      read(from_hex("ffff8100000000300000000101010200c000000000000010010000101234000102000003000000030000000c00090400"
                    "c0a8071400117725")),
      SdFault::kNone);
  EXPECT_TRUE(sd_.reboot_flag());
  EXPECT_TRUE(sd_.unicast_flag());
  ASSERT_EQ(sd_.entries().size(), 1u);
  const SdEntry& offer = sd_.entries()[0];
  EXPECT_EQ(offer.type, EntryType::kOffer);
  EXPECT_EQ(offer.fault, SdFault::kNone);
  EXPECT_EQ(offer.service, 0x1234);
  EXPECT_EQ(offer.instance, 1);
  EXPECT_EQ(offer.major, 2);
  EXPECT_EQ(offer.minor, 3u);
  EXPECT_EQ(offer.ttl_s, 3u);
  ASSERT_EQ(sd_.endpoint_of(offer, Family::kIpv4, Purpose::kUnicast, endpoint_), SdFault::kNone);
  EXPECT_EQ(endpoint_, endpoint(0xC0A80714, 30501));
  EXPECT_EQ(sd_.endpoint_of(offer, Family::kIpv6, Purpose::kUnicast, endpoint_), SdFault::kEndpointMissing);
  EXPECT_EQ(sd_.endpoint_of(offer, Family::kIpv4, Purpose::kMulticast, endpoint_), SdFault::kEndpointMissing);
  EXPECT_EQ(sd_.sd_endpoint(Family::kIpv4, endpoint_), SdFault::kEndpointMissing);
}

TEST_F(SdTest, ReadsTwoRunsConfigurationLoadBalancingAndIpv6) {
  ASSERT_EQ(
      read(from_hex("ffff8100000000670000000201010200c000000000000020010100121234000102000003000000030100000056780009"
                    "01000000000000000000003300100100056162633d78076465663d3132330000150600fd000000000000000000000000"
                    "000020001177250005020000020005")),
      SdFault::kNone);
  ASSERT_EQ(sd_.entries().size(), 2u);
  ASSERT_EQ(sd_.options().size(), 3u);
  const SdEntry& offer = sd_.entries()[0];
  EXPECT_EQ(offer.fault, SdFault::kNone);
  ASSERT_EQ(sd_.run(offer, 0).size(), 1u);
  EXPECT_EQ(sd_.run(offer, 0)[0].type, OptionType::kIpv6Endpoint);
  ASSERT_EQ(sd_.run(offer, 1).size(), 2u);
  EXPECT_EQ(sd_.run(offer, 1)[0].type, OptionType::kConfiguration);
  ASSERT_EQ(sd_.endpoint_of(offer, Family::kIpv6, Purpose::kUnicast, endpoint_), SdFault::kNone);
  EXPECT_EQ(endpoint_, (Endpoint{IpAddress::v6(kServer6), 30501}));
  EXPECT_EQ(sd_.options()[2].priority, 2);
  EXPECT_EQ(sd_.options()[2].weight, 5);
  EXPECT_EQ(sd_.entries()[1].service, 0x5678);
  EXPECT_EQ(sd_.entries()[1].ttl_s, 0u) << "StopOffer";
}

TEST_F(SdTest, ReadsAcksAndNacks) {
  ASSERT_EQ(
      read(from_hex("ffff8100000000300000000301010200c000000000000010070000101234000102000003000200100000000c00091400"
                    "ef01020300117788")),
      SdFault::kNone);
  const SdEntry& ack = sd_.entries()[0];
  EXPECT_EQ(ack.type, EntryType::kSubscribeAck);
  EXPECT_EQ(ack.eventgroup, 0x10);
  EXPECT_EQ(ack.counter, 2);
  ASSERT_EQ(sd_.endpoint_of(ack, Family::kIpv4, Purpose::kMulticast, endpoint_), SdFault::kNone);
  EXPECT_EQ(endpoint_, endpoint(0xEF010203, 30600));

  ASSERT_EQ(read(from_hex("ffff810000000024000000040101020040000000000000100700000012340001020000000000001000000000")),
            SdFault::kNone);
  EXPECT_FALSE(sd_.reboot_flag());
  EXPECT_EQ(sd_.entries()[0].ttl_s, 0u);
}

TEST_F(SdTest, FindsTheSdEndpointWithoutAReference) {
  ASSERT_EQ(
      read(from_hex("ffff81000000003c0000000101010200c0000000000000100101001012340001020000030000000300000018000924"
                    "00c0a807150011771b00090400c0a8071400117725")),
      SdFault::kNone);
  ASSERT_EQ(sd_.sd_endpoint(Family::kIpv4, endpoint_), SdFault::kNone);
  EXPECT_EQ(endpoint_, endpoint(0xC0A80715, 30491));
  EXPECT_EQ(sd_.sd_endpoint(Family::kIpv6, endpoint_), SdFault::kEndpointMissing);

  EXPECT_EQ(read_sd({.options = {ipv4_option(0xE0000001, 30490, 0x24)}}), SdFault::kNone);
  EXPECT_EQ(sd_.sd_endpoint(Family::kIpv4, endpoint_), SdFault::kEndpointAddress);
  EXPECT_EQ(read_sd({.options = {test::option(0x24, Bytes(5))}}), SdFault::kNone);
  EXPECT_EQ(sd_.sd_endpoint(Family::kIpv4, endpoint_), SdFault::kOptionContent);
}

TEST_F(SdTest, RefusesOtherHeaders) {
  const Bytes payload = test::sd_payload({});
  EXPECT_EQ(read(test::message(test::kSdHeader, payload)), SdFault::kNone);
  const auto with = [&](auto change) {
    test::Header header = test::kSdHeader;
    change(header);
    return read(test::message(header, payload));
  };
  EXPECT_EQ(with([](test::Header& h) { h.service = 0xFFFE; }), SdFault::kHeader);
  EXPECT_EQ(with([](test::Header& h) { h.method = 0x8000; }), SdFault::kHeader);
  EXPECT_EQ(with([](test::Header& h) { h.interface = 2; }), SdFault::kHeader);
  EXPECT_EQ(with([](test::Header& h) { h.type = 0x01; }), SdFault::kHeader);
  EXPECT_EQ(with([](test::Header& h) { h.type = 0x22; }), SdFault::kHeader);
  EXPECT_EQ(with([](test::Header& h) { h.return_code = 1; }), SdFault::kHeader);
}

TEST_F(SdTest, ContradictoryLengthsAreNamed) {
  const auto payload = [](std::uint32_t entries_bytes, std::size_t entries, std::uint32_t options_bytes,
                          const Bytes& options) {
    Bytes bytes{0xC0, 0, 0, 0};
    test::append_number(bytes, entries_bytes, 4);
    bytes.resize(bytes.size() + entries);
    test::append_number(bytes, options_bytes, 4);
    test::append(bytes, options);
    return bytes;
  };
  EXPECT_EQ(read_payload(payload(16, 16, 0, {})), SdFault::kNone);
  for (std::size_t size = 0; size < 12; ++size) EXPECT_EQ(read_payload(Bytes(size)), SdFault::kTooShort);
  EXPECT_EQ(read_payload(payload(32, 16, 0, {})), SdFault::kEntriesLength);
  EXPECT_EQ(read_payload(payload(8, 16, 0, {})), SdFault::kEntriesLength);
  EXPECT_EQ(read_payload(payload(0xFFFFFFF0, 16, 0, {})), SdFault::kEntriesLength);
  EXPECT_EQ(read_payload(payload(16, 16, 12, {})), SdFault::kOptionsLength);
  EXPECT_EQ(read_payload(payload(16, 16, 0, Bytes(4))), SdFault::kOptionsLength);
  EXPECT_EQ(read_payload(payload(16, 16, 0xFFFFFFFF, Bytes(4))), SdFault::kOptionsLength);
  EXPECT_EQ(read_payload(payload(65 * 16, 65 * 16, 0, {})), SdFault::kTooManyEntries);
  EXPECT_EQ(read_payload(payload(64 * 16, 64 * 16, 0, {})), SdFault::kNone);
  const auto with_options = [&](const Bytes& options) {
    return read_payload(payload(0, 0, static_cast<std::uint32_t>(options.size()), options));
  };
  EXPECT_EQ(with_options({0, 1, 0x01}), SdFault::kOptionLength);
  EXPECT_EQ(with_options({0, 0, 0x01, 0}), SdFault::kOptionLength);
  EXPECT_EQ(with_options({0, 0, 0x33, 0, 1, 0x33, 0}), SdFault::kOptionLength);
  EXPECT_EQ(with_options({0, 9, 0x04, 0, 1}), SdFault::kOptionLength);
  EXPECT_EQ(with_options({0xFF, 0xFF, 0x04, 0, 1}), SdFault::kOptionLength);
  EXPECT_EQ(with_options({0, 1, 0x77}), SdFault::kOptionLength);
  EXPECT_TRUE(sd_.options().empty());
  Bytes many;
  for (int i = 0; i < 65; ++i) test::append(many, {{0, 1, 0x77, 0}});
  EXPECT_EQ(with_options(many), SdFault::kTooManyOptions);
  many.resize(many.size() - 4);
  EXPECT_EQ(with_options(many), SdFault::kNone);
}

TEST_F(SdTest, ABadEntryDoesNotHarmTheOthers) {
  const std::vector<Bytes> options{ipv4_option(0x0A000001, 1000), test::option(0x04, Bytes(7)),
                                   test::option(0x33, Bytes(2)), test::option(0x33, Bytes(2), true)};
  ASSERT_EQ(read_sd({.entries = {{.index_1 = 3, .number_1 = 2},
                                 {.index_1 = 0, .index_2 = 200, .number_1 = 1, .number_2 = 15},
                                 {.index_1 = 1, .number_1 = 1},
                                 {.index_1 = 0, .index_2 = 2, .number_1 = 1, .number_2 = 1},
                                 {.index_1 = 0, .index_2 = 3, .number_1 = 1, .number_2 = 1},
                                 {.type = 0x04},
                                 {.index_1 = 99, .number_1 = 0},
                                 {.number_1 = 1}},
                     .options = options}),
            SdFault::kNone);
  const std::vector expected{SdFault::kFirstRun, SdFault::kSecondRun, SdFault::kOptionContent, SdFault::kOptionUnknown,
                             SdFault::kNone,     SdFault::kEntryType, SdFault::kNone,          SdFault::kNone};
  ASSERT_EQ(sd_.entries().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(sd_.entries()[i].fault, expected[i]) << i;
  EXPECT_EQ(sd_.endpoint_of(sd_.entries()[7], Family::kIpv4, Purpose::kUnicast, endpoint_), SdFault::kNone);
}

TEST_F(SdTest, InvalidEndpointsAreNamed) {
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 1000)}), SdFault::kNone);
  EXPECT_EQ(offer_fault({}), SdFault::kEndpointMissing);
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 1000, 0x04, 0x06)}), SdFault::kEndpointMissing) << "TCP only";
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 1000, 0x04, 0x06), ipv4_option(0x0A000001, 1000)}), SdFault::kNone);
  EXPECT_EQ(offer_fault({ipv4_option(0, 1000)}), SdFault::kEndpointAddress);
  EXPECT_EQ(offer_fault({ipv4_option(0xE0000001, 1000)}), SdFault::kEndpointAddress);
  EXPECT_EQ(offer_fault({ipv4_option(0xFFFFFFFF, 1000)}), SdFault::kEndpointAddress);
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 0)}), SdFault::kEndpointAddress);
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 1000), ipv4_option(0x0A000001, 1000)}), SdFault::kNone);
  EXPECT_EQ(offer_fault({ipv4_option(0x0A000001, 1000), ipv4_option(0x0A000002, 1000)}), SdFault::kEndpointConflict);

  const auto offer6 = [&](const IpAddress& address) {
    EXPECT_EQ(read_sd({.entries = {{.number_1 = 1}}, .options = {test::ipv6_option(address, 9)}}), SdFault::kNone);
    return sd_.endpoint_of(sd_.entries()[0], Family::kIpv6, Purpose::kUnicast, endpoint_);
  };
  EXPECT_EQ(offer6(IpAddress::v6(kServer6)), SdFault::kNone);
  EXPECT_EQ(offer6(IpAddress{}), SdFault::kEndpointAddress);
  EXPECT_EQ(offer6(IpAddress::v4(0x0A000001)), SdFault::kEndpointAddress) << "mapped IPv4";
  IpAddress multicast{};
  multicast.bytes[0] = 0xFF;
  EXPECT_EQ(offer6(multicast), SdFault::kEndpointAddress);

  EXPECT_EQ(read_sd({.entries = {{.number_1 = 1}}, .options = {ipv4_option(0x0A000001, 9, 0x14)}}), SdFault::kNone);
  EXPECT_EQ(sd_.endpoint_of(sd_.entries()[0], Family::kIpv4, Purpose::kMulticast, endpoint_),
            SdFault::kEndpointAddress);
}

TEST_F(SdTest, StringsMustFitTheirOption) {
  EXPECT_EQ(offer_fault({test::option(0x01, {0}), ipv4_option(0x0A000001, 1000)}), SdFault::kNone);
  EXPECT_EQ(offer_fault({test::option(0x01, {3, 'a', '=', '1', 0}), ipv4_option(0x0A000001, 1000)}), SdFault::kNone);
  for (const Bytes& bad : {Bytes{}, Bytes{3, 'a', '=', '1'}, Bytes{4, 'a', '=', '1', 0}, Bytes{0, 0}, Bytes{200}}) {
    EXPECT_EQ(offer_fault({test::option(0x01, bad), ipv4_option(0x0A000001, 1000)}), SdFault::kOptionContent);
  }
  EXPECT_EQ(offer_fault({test::option(0x02, Bytes(5)), ipv4_option(0x0A000001, 1000)}), SdFault::kOptionContent);
}

TEST_F(SdTest, EveryFaultHasADescription) {
  for (int fault = 1; fault <= static_cast<int>(SdFault::kEndpointMissing); ++fault) {
    EXPECT_TRUE(describe(static_cast<SdFault>(fault)).starts_with("SOME/IP-SD: ")) << fault;
    EXPECT_NE(describe(static_cast<SdFault>(fault)), "SOME/IP-SD: unknown fault") << fault;
  }
}

TEST(SdWriter, WritesWhatScapyWrites) {
  SdWriter writer;
  ASSERT_TRUE(writer.find(0x1234, kAnyInstance, kAnyMajor));
  EXPECT_THAT(writer.finish(1, true),
              testing::ElementsAreArray(from_hex(
                  "ffff8100000000240000000101010200c000000000000010000000001234ffffffffffffffffffff00000000")));

  const EventgroupId id{.service = 0x1234, .instance = 1, .major = 2, .eventgroup = 0x10};
  writer.clear();
  ASSERT_TRUE(writer.stop_subscribe(id, endpoint(0xC0A80702, 40001)));
  ASSERT_TRUE(writer.subscribe(id, 3, endpoint(0xC0A80702, 40001)));
  EXPECT_THAT(writer.finish(1, true),
              testing::ElementsAreArray(
                  from_hex("ffff8100000000400000000101010200c0000000000000200600001012340001020000000000001006"
                           "0000101234000102000003000000100000000c00090400c0a8070200119c41")));

  writer.clear();
  EventgroupId second = id;
  second.counter = 1;
  std::array<std::uint8_t, 16> client6 = kServer6;
  client6[15] = 2;
  ASSERT_TRUE(writer.subscribe(second, 3, {IpAddress::v6(client6), 40001}));
  EXPECT_THAT(writer.finish(1, true),
              testing::ElementsAreArray(
                  from_hex("ffff81000000003c0000000101010200c000000000000010060000101234000102000003000100100000"
                           "001800150600fd00000000000000000000000000000200119c41")));
  EXPECT_EQ(writer.finish(0xABCD, false)[11], 0xCD);
  EXPECT_EQ(writer.finish(0xABCD, false)[16], 0x40);
}

TEST(SdWriter, RejectsEntriesThatDoNotFitAndItsMessagesAreReadable) {
  SdWriter writer;
  EXPECT_TRUE(writer.is_empty());
  const EventgroupId id{.service = 1, .instance = 2, .major = 3, .eventgroup = 4, .counter = 5};
  for (std::uint16_t i = 0; i < SdWriter::kMaxOptions; ++i) {
    EXPECT_TRUE(writer.subscribe(id, 6, {IpAddress::v6(kServer6), static_cast<std::uint16_t>(1000 + i)}));
  }
  EXPECT_FALSE(writer.subscribe(id, 6, endpoint(1, 1)));
  while (writer.find(1, 2, 3)) {
  }
  EXPECT_FALSE(writer.stop_subscribe(id, {IpAddress::v6(kServer6), 1000}));
  const std::span<const std::uint8_t> datagram = writer.finish(1, true);
  EXPECT_LE(datagram.size(), 1400u);

  MessageReader reader(datagram);
  Message message;
  ASSERT_EQ(reader.next(message), ReadResult::kMessage);
  SdMessage sd;
  ASSERT_EQ(sd.read(message), SdFault::kNone);
  ASSERT_EQ(sd.entries().size(), SdWriter::kMaxEntries);
  EXPECT_EQ(sd.entries()[7].counter, 5);
  EXPECT_EQ(sd.run(sd.entries()[7], 0)[0].endpoint.port, 1007);
}

TEST_F(SdTest, ChangedMessagesAreRefusedOrStayWithinTheirBytesWithoutAllocating) {
  std::mt19937 random(3);
  const Bytes sound = test::sd_datagram(
      {.entries = {{.number_1 = 1, .number_2 = 2},
                   {.type = 0x07, .index_1 = 3, .number_1 = 1},
                   {.index_1 = 4, .number_1 = 2}},
       .options = {ipv4_option(0x0A000001, 1000), test::option(0x01, {1, 'a', 0}), test::option(0x02, Bytes(4)),
                   ipv4_option(0xEF000001, 9, 0x14), test::ipv6_option(IpAddress::v6(kServer6), 7),
                   ipv4_option(0x0A000002, 30490, 0x24)}});
  std::vector<Bytes> datagrams;
  for (int i = 0; i < 20'000; ++i) datagrams.push_back(test::mutated(random, sound));
  const std::uint64_t before = runtime::counted_allocations();
  std::size_t accepted = 0, refused = 0;
  {
    const runtime::CountAllocations counting;
    for (const Bytes& datagram : datagrams) {
      MessageReader reader(datagram);
      Message message;
      for (ReadResult result; (result = reader.next(message)) != ReadResult::kEnd;) {
        if (result != ReadResult::kMessage) continue;
        if (sd_.read(message) != SdFault::kNone) {
          ++refused;
          continue;
        }
        ++accepted;
        for (const SdEntry& entry : sd_.entries()) {
          if (entry.fault != SdFault::kNone) continue;
          for (const std::size_t which : {0, 1}) {
            for (const SdOption& o : sd_.run(entry, which)) {
              ASSERT_LE(o.content.data() + o.content.size(), datagram.data() + datagram.size());
            }
          }
          static_cast<void>(sd_.endpoint_of(entry, Family::kIpv4, Purpose::kUnicast, endpoint_));
        }
      }
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_GT(accepted, 1000u);
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace boresight::ingest::someip
