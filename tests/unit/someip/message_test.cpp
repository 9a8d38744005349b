// The messages of a datagram. The two hexadecimal messages were made by scapy 2.5 (scapy.contrib.automotive.someip).
#include "services/common/someip/message.hpp"

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/someip/bytes.hpp"

namespace boresight::ingest::someip {

using namespace boresight::someip;

namespace {

using test::append;
using test::Bytes;
using test::from_hex;

std::vector<ReadResult> read_all(const Bytes& datagram, std::vector<Message>* messages = nullptr) {
  MessageReader reader(datagram);
  std::vector<ReadResult> results;
  Message message;
  for (;;) {
    results.push_back(reader.next(message));
    if (results.back() == ReadResult::kEnd || results.size() > 200) return results;
    if (results.back() == ReadResult::kMessage && messages != nullptr) messages->push_back(message);
  }
}

TEST(SomeIpMessage, ReadsEventAndResponseOfScapyFromOneDatagram) {
  Bytes datagram = from_hex("123480210000000d00000007010202000102030405");
  append(datagram, from_hex("123400420000000a1111000801018000aabb"));
  std::vector<Message> messages;
  ASSERT_EQ(read_all(datagram, &messages), (std::vector{ReadResult::kMessage, ReadResult::kMessage, ReadResult::kEnd}));
  const Message& event = messages[0];
  EXPECT_EQ(event.service, 0x1234);
  EXPECT_EQ(event.method, 0x8021);
  EXPECT_EQ(event.client, 0);
  EXPECT_EQ(event.session, 7);
  EXPECT_EQ(event.protocol_version, 1);
  EXPECT_EQ(event.interface_version, 2);
  EXPECT_EQ(event.type, MessageType::kNotification);
  EXPECT_FALSE(event.tp);
  EXPECT_EQ(event.return_code, 0);
  EXPECT_THAT(event.payload, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(event.protected_data, testing::ElementsAre(0, 0, 0, 7, 1, 2, 2, 0, 1, 2, 3, 4, 5));
  EXPECT_EQ(messages[1].type, MessageType::kResponse);
  EXPECT_EQ(messages[1].client, 0x1111);
  EXPECT_THAT(messages[1].payload, testing::ElementsAre(0xAA, 0xBB));
}

TEST(SomeIpMessage, SplitsTheTpBitOffTheType) {
  std::vector<Message> messages;
  read_all(test::message({.type = 0x22}, Bytes(20)), &messages);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_TRUE(messages[0].tp);
  EXPECT_EQ(messages[0].type, MessageType::kNotification);
}

TEST(SomeIpMessage, AcceptsAnEmptyPayload) {
  std::vector<Message> messages;
  EXPECT_EQ(read_all(test::message({}, {}), &messages), (std::vector{ReadResult::kMessage, ReadResult::kEnd}));
  EXPECT_TRUE(messages.at(0).payload.empty());
  EXPECT_EQ(messages.at(0).protected_data.size(), 8u);
}

TEST(SomeIpMessage, AcceptsEveryMessageType) {
  for (unsigned type = 0; type < 256; ++type) {
    const unsigned plain = type & 0xDFu;
    const bool exists = plain <= 2 || plain == 0x80 || plain == 0x81;
    EXPECT_EQ(read_all(test::message({.type = static_cast<std::uint8_t>(type)}, Bytes(4))).front(),
              exists ? ReadResult::kMessage : ReadResult::kMessageType)
        << type;
  }
}

TEST(SomeIpMessage, AMessageOfAnotherVersionOrTypeIsSkippedAlone) {
  const Bytes good = test::message({}, Bytes(3, 9));
  Bytes datagram = good;
  append(datagram, test::message({.protocol = 2}, Bytes(5)));
  append(datagram, good);
  append(datagram, test::message({.type = 0x40}, Bytes(5)));
  append(datagram, good);
  EXPECT_EQ(read_all(datagram), (std::vector{ReadResult::kMessage, ReadResult::kProtocolVersion, ReadResult::kMessage,
                                             ReadResult::kMessageType, ReadResult::kMessage, ReadResult::kEnd}));
}

TEST(SomeIpMessage, AWrongLengthDropsTheRestAndIsReportedOnce) {
  const Bytes good = test::message({}, Bytes(3, 9));
  const auto with_length = [&](std::uint32_t length) {
    Bytes bad = good;
    for (unsigned i = 0; i < 4; ++i) bad[4 + i] = static_cast<std::uint8_t>(length >> (24 - 8 * i));
    Bytes datagram = good;
    append(datagram, bad);
    append(datagram, good);
    return read_all(datagram);
  };
  const auto gives_up = [](ReadResult reason) { return std::vector{ReadResult::kMessage, reason, ReadResult::kEnd}; };
  EXPECT_EQ(with_length(0), gives_up(ReadResult::kLengthTooSmall));
  EXPECT_EQ(with_length(7), gives_up(ReadResult::kLengthTooSmall));
  EXPECT_EQ(with_length(static_cast<std::uint32_t>(2 * good.size() - 8 + 1)), gives_up(ReadResult::kBeyondDatagram));
  EXPECT_EQ(with_length(0xFFFFFFFF), gives_up(ReadResult::kBeyondDatagram));
}

TEST(SomeIpMessage, ATruncatedHeaderIsAFault) {
  const Bytes good = test::message({}, Bytes(3, 9));
  for (std::size_t left = 1; left < kHeaderBytes; ++left) {
    Bytes datagram = good;
    append(datagram, std::span(good).first(left));
    EXPECT_EQ(read_all(datagram), (std::vector{ReadResult::kMessage, ReadResult::kHeaderCut, ReadResult::kEnd}))
        << left;
  }
  EXPECT_EQ(read_all({}), (std::vector{ReadResult::kHeaderCut, ReadResult::kEnd}));
}

TEST(SomeIpMessage, EveryFaultHasADescription) {
  for (const ReadResult fault : {ReadResult::kHeaderCut, ReadResult::kLengthTooSmall, ReadResult::kBeyondDatagram,
                                 ReadResult::kProtocolVersion, ReadResult::kMessageType}) {
    EXPECT_FALSE(describe(fault).empty());
  }
  EXPECT_EQ(describe(ReadResult::kMessage), "");
}

TEST(SomeIpMessage, WritesTheHeaderItRead) {
  for (const std::uint8_t type : {std::uint8_t{0x02}, std::uint8_t{0x22}, std::uint8_t{0x81}}) {
    const Bytes bytes = test::message({.client = 0x4321, .type = type, .return_code = 5}, Bytes(33, 1));
    std::vector<Message> messages;
    read_all(bytes, &messages);
    std::array<std::uint8_t, kHeaderBytes> written{};
    write_header(messages.at(0), 33, written);
    EXPECT_THAT(written, testing::ElementsAreArray(std::span(bytes).first(kHeaderBytes)));
  }
}

TEST(SomeIpMessage, ChangedDatagramsNeverHarmTheMessagesBefore) {
  std::mt19937 random(1);
  const Bytes first = test::message({}, test::random_bytes(random, 50));
  Bytes rest = test::message({.session = 8}, test::random_bytes(random, 20));
  append(rest, test::message({.session = 9}, test::random_bytes(random, 0)));
  std::vector<Message> messages;
  messages.reserve(200);
  std::vector<Bytes> datagrams;
  for (int i = 0; i < 20'000; ++i) {
    Bytes datagram = first;
    append(datagram, test::mutated(random, rest));
    datagrams.push_back(std::move(datagram));
  }
  const std::uint64_t before = runtime::counted_allocations();
  std::uint64_t firsts = 0;
  for (const Bytes& datagram : datagrams) {
    const runtime::CountAllocations counting;
    MessageReader reader(datagram);
    Message message;
    bool is_first = true;
    for (ReadResult result; (result = reader.next(message)) != ReadResult::kEnd; is_first = false) {
      if (result != ReadResult::kMessage) continue;
      const std::uint8_t* const end = message.protected_data.data() + message.protected_data.size();
      ASSERT_LE(end, datagram.data() + datagram.size());
      firsts += is_first && message.session == 7 && message.payload.size() == 50 ? 1 : 0;
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(firsts, datagrams.size());
}

}  // namespace
}  // namespace boresight::ingest::someip
