// Any text as a mapping file. It must be rejected with an error, or give a decoder that works. The first byte chooses
// the kind.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "services/ingest_gateway/codecs/table_ego.hpp"
#include "services/ingest_gateway/codecs/table_radar.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/fuzz/checked_output.hpp"
#include "tests/fuzz/mapping_texts.hpp"

namespace {

using namespace boresight;
using namespace boresight::ingest;

template <typename Mapping>
void feed(const Mapping& mapping, Decoder& decoder) {
  fuzz::require(!mapping.messages.empty());
  fuzz::CheckedOutput sink(true);
  std::vector<std::uint8_t> payload(64);
  recording::Frame frame;
  const fuzz::NoAllocation guard;
  for (std::int64_t i = 0; i < 64; ++i) {
    const auto& message = mapping.messages[static_cast<std::size_t>(i) % mapping.messages.size()].frame;
    for (std::size_t k = 0; k < payload.size(); ++k) {
      payload[k] = static_cast<std::uint8_t>(static_cast<std::size_t>(i) * k);
    }
    frame.can_id = message.id;
    frame.can_extended = message.extended;
    frame.payload = std::span(payload).first(message.length_bytes);
    decoder.take(frame, {i * 1'000'000, 0, TimeSource::kLinkArrival}, sink);
    sink.require_at_rest();
  }
  decoder.tick(10'000'000'000, sink);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const dbc::Database database = dbc::parse_dbc(fuzz::kDbc, "fuzz.dbc");
  const auto load = [](const std::string&) { return database; };
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    const config::Reader root = config::Reader::parse(text, "fuzz.toml");
    if (data[0] % 2 == 0) {
      const dbc::RadarMapping mapping = read_radar_mapping(root, load);
      TableRadar decoder(mapping);
      feed(mapping, decoder);
    } else {
      const dbc::EgoMapping mapping = read_ego_mapping(root, load);
      TableEgo decoder(mapping);
      feed(mapping, decoder);
    }
  } catch (const config::Error&) {
  }
  return 0;
}
