#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

namespace {

std::string out_of_range(std::string_view field, std::uint64_t value, std::uint64_t least, std::uint64_t greatest) {
  return std::string(field) + " is " + std::to_string(value) + ", must be " + std::to_string(least) + " to " +
         std::to_string(greatest);
}

bool has_data_id_mode(Profile profile) {
  return profile == Profile::kP01 || profile == Profile::kP11;
}

std::uint64_t greatest_data_id(const Config& config) {
  // Only the low nibble of the high byte is sent; the high nibble has no effect, so a value there is an error.
  if (has_data_id_mode(config.profile) && config.data_id_mode == DataIdMode::kNibble) return 0xFFF;
  return config.profile == Profile::kP04 || config.profile == Profile::kP07 ? 0xFFFFFFFF : 0xFFFF;
}

}  // namespace

std::string_view describe(Status status) {
  switch (status) {
    case Status::kInitial:
      return "first message";
    case Status::kOk:
      return "ok";
    case Status::kOkSomeLost:
      return "ok, some lost";
    case Status::kRepeated:
      return "repeated";
    case Status::kWrongSequence:
      return "wrong sequence";
    case Status::kWrongCrc:
      return "wrong CRC";
    case Status::kWrongLength:
      return "wrong length";
    case Status::kWrongDataId:
      return "wrong Data ID";
  }
  return "unknown";
}

std::optional<std::string> validate(const Config& config) {
  if (config.profile > Profile::kP22) {
    return out_of_range("profile", static_cast<std::uint64_t>(config.profile), 0,
                        static_cast<std::uint64_t>(Profile::kP22));
  }
  if (config.profile == Profile::kNone) return std::nullopt;
  if (has_data_id_mode(config.profile)) {
    if (config.data_id_mode > DataIdMode::kNibble) {
      return out_of_range("data_id_mode", static_cast<std::uint64_t>(config.data_id_mode), 0,
                          static_cast<std::uint64_t>(DataIdMode::kNibble));
    }
    if (config.profile == Profile::kP11 && config.data_id_mode != DataIdMode::kBoth &&
        config.data_id_mode != DataIdMode::kNibble) {
      return "data_id_mode of profile 11 must be both or nibble";
    }
  }
  const std::uint64_t id_limit = greatest_data_id(config);
  if (config.data_id > id_limit) return out_of_range("data_id", config.data_id, 0, id_limit);
  if (config.offset_bytes > kMaxOffsetBytes) {
    return out_of_range("offset_bytes", config.offset_bytes, 0, kMaxOffsetBytes);
  }
  const std::uint64_t delta_limit = layout(config.profile).counter_values - 1;
  if (config.max_delta_counter < 1 || config.max_delta_counter > delta_limit) {
    return out_of_range("max_delta_counter", config.max_delta_counter, 1, delta_limit);
  }
  return std::nullopt;
}

}  // namespace boresight::e2e
