#include "services/common/e2e/protector.hpp"

#include "services/common/e2e/header.hpp"

namespace boresight::e2e {

Protector::Protector(const Config& config) : config_(config), counter_(layout(config.profile).first_counter) {}

bool Protector::protect(std::span<std::uint8_t> data) {
  if (config_.profile == Profile::kNone) return true;
  if (!has_room(config_, data)) return false;
  const Layout fields = layout(config_.profile);
  if (fields.length_bytes > 0 && std::uint64_t{data.size()} >> (8 * fields.length_bytes) != 0) return false;

  Header header;
  header.counter = counter_;
  header.length = static_cast<std::uint32_t>(data.size());
  header.data_id = sent_data_id(config_);
  write_fields(config_, header, data);
  write_crc(config_, compute_crc(config_, counter_, data), data);
  counter_ = static_cast<std::uint32_t>((std::uint64_t{counter_} + 1) % fields.counter_values);
  return true;
}

}  // namespace boresight::e2e
