#include "services/common/e2e/header.hpp"

#include <array>
#include <cstddef>

namespace boresight::e2e {

namespace {

std::uint64_t read_big_endian(Bytes field) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : field) value = value << 8 | byte;
  return value;
}

void write_big_endian(std::span<std::uint8_t> field, std::uint64_t value) {
  for (std::size_t i = field.size(); i-- > 0; value >>= 8) field[i] = static_cast<std::uint8_t>(value);
}

std::uint16_t swapped(std::uint64_t value) {
  return static_cast<std::uint16_t>((value & 0xFF) << 8 | (value >> 8 & 0xFF));
}

bool sends_nibble(const Config& config) {
  return (config.profile == Profile::kP01 || config.profile == Profile::kP11) &&
         config.data_id_mode == DataIdMode::kNibble;
}

/// Continues `state` over all data before and after the CRC field.
template <typename Value>
Value around_crc(const Config& config, Value (*update)(Value, Bytes), Value state, Bytes data) {
  const Layout fields = layout(config.profile);
  const std::size_t begin = std::size_t{config.offset_bytes} + fields.crc_at;
  state = update(state, data.first(begin));
  return update(state, data.subspan(begin + fields.crc_bytes));
}

/// P01 and P11: the CRC covers the Data ID first. The 8-bit CRC starts at 0 without a final XOR, unlike SAE J1850
/// itself (PRS_E2EProtocol, "CRC calculation" of profile 1; shown by the public vectors too).
std::uint8_t crc_with_leading_id(const Config& config, std::uint32_t counter, Bytes data) {
  const auto low = static_cast<std::uint8_t>(config.data_id);
  const auto high = static_cast<std::uint8_t>(config.data_id >> 8);
  std::array<std::uint8_t, 2> id{low, high};
  std::size_t id_bytes = 1;
  switch (config.data_id_mode) {
    case DataIdMode::kBoth:
      id_bytes = 2;
      break;
    case DataIdMode::kAlternating:
      if (counter % 2 == 1) id[0] = high;
      break;
    case DataIdMode::kLow:
      break;
    case DataIdMode::kNibble:
      id_bytes = 2;
      id[1] = 0;  // the high byte is sent, so that the CRC does not cover it
      break;
  }
  return around_crc(config, update_crc8, update_crc8(0, Bytes{id}.first(id_bytes)), data);
}

/// P02 and P22: the CRC covers an identifier that changes with the counter last.
std::uint8_t crc_with_listed_id(const Config& config, std::uint32_t counter, Bytes data) {
  const std::uint8_t id = config.data_id_list[counter % config.data_id_list.size()];
  return update_crc8_h2f(around_crc<std::uint8_t>(config, update_crc8_h2f, 0xFF, data), {&id, 1}) ^ 0xFFu;
}

/// P05 and P06: the CRC covers the Data ID last, in the byte order of the profile.
std::uint16_t crc_with_trailing_id(const Config& config, Bytes data, bool low_byte_first) {
  std::array<std::uint8_t, 2> id;
  write_big_endian(id, low_byte_first ? swapped(config.data_id) : config.data_id);
  return update_crc16(around_crc<std::uint16_t>(config, update_crc16, 0xFFFF, data), id);
}

}  // namespace

bool has_room(const Config& config, Bytes data) {
  const std::size_t header = header_bytes(config.profile);
  return data.size() >= header && data.size() - header >= config.offset_bytes;
}

Header read_header(const Config& config, Bytes data) {
  const Layout fields = layout(config.profile);
  const Bytes at = data.subspan(config.offset_bytes);
  Header header;
  header.crc = read_big_endian(at.subspan(fields.crc_at, fields.crc_bytes));
  if (config.profile == Profile::kP05) header.crc = swapped(header.crc);
  header.length = static_cast<std::uint32_t>(read_big_endian(at.subspan(fields.length_at, fields.length_bytes)));
  header.data_id = static_cast<std::uint32_t>(read_big_endian(at.subspan(fields.data_id_at, fields.data_id_bytes)));
  if (fields.counter_bytes > 0) {
    header.counter = static_cast<std::uint32_t>(read_big_endian(at.subspan(fields.counter_at, fields.counter_bytes)));
  } else if (fields.header_bytes > 0) {
    header.counter = at[fields.counter_at] & 0x0Fu;
    if (sends_nibble(config)) header.data_id = at[fields.counter_at] >> 4;
  }
  return header;
}

void write_fields(const Config& config, const Header& header, std::span<std::uint8_t> data) {
  const Layout fields = layout(config.profile);
  const std::span<std::uint8_t> at = data.subspan(config.offset_bytes);
  write_big_endian(at.subspan(fields.length_at, fields.length_bytes), header.length);
  write_big_endian(at.subspan(fields.data_id_at, fields.data_id_bytes), header.data_id);
  if (fields.counter_bytes > 0) {
    write_big_endian(at.subspan(fields.counter_at, fields.counter_bytes), header.counter);
  } else if (fields.header_bytes > 0) {
    const std::uint32_t high = sends_nibble(config) ? header.data_id << 4 : at[fields.counter_at] & 0xF0u;
    at[fields.counter_at] = static_cast<std::uint8_t>(high | header.counter);
  }
}

void write_crc(const Config& config, std::uint64_t crc, std::span<std::uint8_t> data) {
  const Layout fields = layout(config.profile);
  const std::size_t begin = std::size_t{config.offset_bytes} + fields.crc_at;
  write_big_endian(data.subspan(begin, fields.crc_bytes), config.profile == Profile::kP05 ? swapped(crc) : crc);
}

std::uint64_t compute_crc(const Config& config, std::uint32_t counter, Bytes data) {
  switch (config.profile) {
    case Profile::kNone:
      return 0;
    case Profile::kP01:
    case Profile::kP11:
      return crc_with_leading_id(config, counter, data);
    case Profile::kP02:
    case Profile::kP22:
      return crc_with_listed_id(config, counter, data);
    case Profile::kP04:
      return ~around_crc<std::uint32_t>(config, update_crc32_p4, 0xFFFFFFFF, data);
    case Profile::kP05:
      return crc_with_trailing_id(config, data, true);
    case Profile::kP06:
      return crc_with_trailing_id(config, data, false);
    case Profile::kP07:
      return ~around_crc<std::uint64_t>(config, update_crc64, ~std::uint64_t{0}, data);
  }
  return 0;
}

std::uint32_t sent_data_id(const Config& config) {
  if (sends_nibble(config)) return config.data_id >> 8 & 0x0F;
  return layout(config.profile).data_id_bytes > 0 ? config.data_id : 0;
}

}  // namespace boresight::e2e
