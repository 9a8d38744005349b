// Messages whose values all differ, and samples as the bytes that are sent.
#pragma once

#include <cstring>
#include <vector>

#include <fastdds/rtps/common/SerializedPayload.h>

#include "interfaces/messages/header.hpp"

namespace boresight::dds::samples {

using Bytes = std::vector<unsigned char>;

/// A message in which each word of four bytes is another float, so that a value in the wrong field is seen.
/// Enumerations and counts are for the test to set.
template <typename Message>
[[nodiscard]] Message distinct() {
  static_assert(kIsPlainMessage<Message> && sizeof(Message) % sizeof(float) == 0);
  std::vector<float> words(sizeof(Message) / sizeof(float));
  float value = 1.0F;
  for (float& word : words) word = value += 0.25F;
  Message message;
  std::memcpy(static_cast<void*>(&message), words.data(), sizeof(Message));
  return message;
}

template <typename PubSubType, typename Sample>
[[nodiscard]] Bytes sent(const Sample& sample) {
  PubSubType type;
  Sample copy = sample;
  eprosima::fastrtps::rtps::SerializedPayload_t payload(type.getSerializedSizeProvider(&copy)());
  if (!type.serialize(&copy, &payload)) return {};
  return {payload.data, payload.data + payload.length};
}

/// What a reader gets.
template <typename PubSubType, typename Sample>
[[nodiscard]] Sample received(const Sample& sample) {
  PubSubType type;
  Bytes bytes = sent<PubSubType>(sample);
  eprosima::fastrtps::rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
  std::memcpy(payload.data, bytes.data(), bytes.size());
  payload.length = static_cast<std::uint32_t>(bytes.size());
  Sample out;
  if (!type.deserialize(&payload, &out)) return {};
  return out;
}

/// The offsets in the message, from `begin` to `end`, of bytes that change nothing in `bytes_of(message)`.
template <typename Message, typename BytesOf>
[[nodiscard]] std::vector<std::size_t> without_effect(const Message& message, std::size_t begin, std::size_t end,
                                                      const BytesOf& bytes_of) {
  const Bytes before = bytes_of(message);
  std::vector<std::size_t> offsets;
  auto changed = std::make_unique<Message>(message);
  auto* const raw = reinterpret_cast<unsigned char*>(changed.get());
  for (std::size_t i = begin; i < end; ++i) {
    raw[i] ^= 1U;
    if (bytes_of(*changed) == before) offsets.push_back(i);
    raw[i] ^= 1U;
  }
  return offsets;
}

/// `count` successive offsets, to build an expectation.
inline void append(std::vector<std::size_t>& offsets, std::size_t begin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) offsets.push_back(begin + i);
}

}  // namespace boresight::dds::samples
