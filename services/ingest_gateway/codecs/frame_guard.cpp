#include "services/ingest_gateway/codecs/frame_guard.hpp"

#include "interfaces/wire/toyota.hpp"
#include "services/ingest_gateway/codecs/protection.hpp"

namespace boresight::ingest {

FrameGuard::FrameGuard(const dbc::MappedMessage& message)
    : length_bytes_(message.length_bytes),
      checksum_(message.checksum),
      e2e_(message.protection),
      too_short_(message.name + ": frame is shorter than " + std::to_string(message.length_bytes) + " bytes"),
      bad_checksum_(message.name + ": checksum does not match") {
  for (std::size_t i = 0; i < bad_protection_.size(); ++i) {
    bad_protection_[i] = message.name + ": E2E: " + std::string(e2e::describe(static_cast<e2e::Status>(i)));
  }
}

std::span<const std::uint8_t> FrameGuard::usable(const recording::Frame& frame, DecoderOutput& output) {
  if (frame.payload.size() < length_bytes_) {
    output.fault(Fault::kWireLength, too_short_);
    return {};
  }
  const auto payload = frame.payload.first(length_bytes_);
  if (checksum_ == dbc::Checksum::kToyota && wire::toyota::checksum(frame.can_id, payload) != payload.back()) {
    output.fault(Fault::kWireValue, bad_checksum_);
    return {};
  }
  if (e2e_.config().profile != e2e::Profile::kNone) {
    const e2e::Status status = check_protection(e2e_, payload, output);
    if (!e2e::is_acceptable(status)) {
      output.fault(Fault::kWireValue, bad_protection_[static_cast<std::size_t>(status)]);
      return {};
    }
  }
  return payload;
}

}  // namespace boresight::ingest
