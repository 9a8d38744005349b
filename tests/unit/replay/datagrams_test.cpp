#include "services/replay/core/datagrams.hpp"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::replay {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes message_of(std::size_t payload_bytes) {
  Bytes message(16 + payload_bytes);
  std::iota(message.begin(), message.end(), std::uint8_t{1});
  message[14] = 0x02;
  return message;
}

std::vector<Bytes> split(const Bytes& message) {
  std::vector<Bytes> datagrams;
  for_each_datagram(message, [&](std::span<const std::uint8_t> d) { datagrams.emplace_back(d.begin(), d.end()); });
  return datagrams;
}

std::uint32_t u32_at(const Bytes& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | bytes[at + 3];
}

TEST(Datagrams, UpToTheLimitAMessageIsNotSegmented) {
  for (const std::size_t bytes : {0u, 20u, 1392u})
    EXPECT_EQ(split(message_of(bytes)), std::vector<Bytes>({message_of(bytes)}));
}

TEST(Datagrams, ReassembledSegmentsAreTheMessage) {
  for (const std::size_t bytes : {1393u, 1408u, 2784u, 2785u, 49208u}) {
    const Bytes message = message_of(bytes);
    const auto segments = split(message);
    ASSERT_EQ(segments.size(), (bytes + 1391) / 1392);
    Bytes together(message.begin(), message.begin() + 16);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Bytes& s = segments[i];
      const bool last = i + 1 == segments.size();
      ASSERT_GT(s.size(), 20u);
      EXPECT_EQ(u32_at(s, 4), s.size() - 8);
      EXPECT_EQ(s[14], 0x22);
      Bytes plain(s.begin(), s.begin() + 16);
      plain[14] = 0x02;
      std::copy(message.begin() + 4, message.begin() + 8, plain.begin() + 4);
      EXPECT_EQ(plain, Bytes(message.begin(), message.begin() + 16)) << "the rest of the header is repeated";
      EXPECT_EQ(u32_at(s, 16), i * 1392 + (last ? 0 : 1));
      if (!last) {
        EXPECT_EQ(s.size() - 20, 1392u);
      }
      together.insert(together.end(), s.begin() + 20, s.end());
    }
    EXPECT_EQ(together, message);
  }
}

TEST(Datagrams, ShortMessagesShareADatagram) {
  SharedDatagram shared;
  const Bytes small = message_of(52);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(shared.add(small));
  EXPECT_EQ(shared.content().size(), 20 * small.size());
  EXPECT_FALSE(shared.add(message_of(1392 - 20 * 68 + 1)));
  EXPECT_EQ(shared.content().size(), 20 * small.size());
  EXPECT_TRUE(shared.add(message_of(1392 - 20 * 68)));
  EXPECT_EQ(shared.content().size(), kMaxDatagramBytes);
  shared.clear();
  EXPECT_TRUE(shared.empty());
  EXPECT_TRUE(shared.add(message_of(1392)));
}

}  // namespace
}  // namespace boresight::replay
