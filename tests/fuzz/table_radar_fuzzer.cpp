// Any frames to mapped decoders of radars and ego signals. The first byte chooses the mapping. Each frame has a byte
// for the message, one for the length, one for the time in ms since the last frame, and the payload.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/ingest_gateway/codecs/table_ego.hpp"
#include "services/ingest_gateway/codecs/table_radar.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/fuzz/checked_output.hpp"
#include "tests/fuzz/mapping_texts.hpp"

namespace {

using namespace boresight;
using namespace boresight::ingest;

struct Mappings {
  Mappings() {
    const auto load = [](const std::string&) { return dbc::parse_dbc(fuzz::kDbc, "fuzz.dbc"); };
    for (const std::string_view text : fuzz::kRadarMappings) {
      radars.push_back(read_radar_mapping(config::Reader::parse(text, "fuzz.toml"), load));
    }
    for (const std::string_view text : fuzz::kEgoMappings) {
      egos.push_back(read_ego_mapping(config::Reader::parse(text, "fuzz.toml"), load));
    }
  }
  std::vector<dbc::RadarMapping> radars;
  std::vector<dbc::EgoMapping> egos;
};

template <typename Mapping>
void play(const Mapping& mapping, Decoder& decoder, std::span<const std::uint8_t> data) {
  fuzz::CheckedOutput sink(true);
  recording::Frame frame;
  std::int64_t now_ns = 0;
  const fuzz::NoAllocation guard;
  while (data.size() >= 3) {
    const auto& message = mapping.messages[data[0] % mapping.messages.size()].frame;
    // The right length, unless the highest bits choose another.
    const std::size_t wanted = data[1] < 192 ? message.length_bytes : data[1] & 63u;
    now_ns += (std::int64_t{data[2]} - 16) * 1'000'000;
    data = data.subspan(3);
    frame.can_id = message.id;
    frame.can_extended = message.extended;
    frame.payload = data.first(std::min(wanted, data.size()));
    data = data.subspan(frame.payload.size());
    decoder.take(frame, {now_ns, 0, TimeSource::kLinkArrival}, sink);
    sink.require_at_rest();
  }
  decoder.tick(now_ns + 1'000'000'000, sink);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const Mappings mappings;
  const std::size_t choice = data[0] % (mappings.radars.size() + mappings.egos.size());
  const std::span<const std::uint8_t> frames(data + 1, size - 1);
  if (choice < mappings.radars.size()) {
    TableRadar decoder(mappings.radars[choice]);
    play(mappings.radars[choice], decoder, frames);
  } else {
    TableEgo decoder(mappings.egos[choice - mappings.radars.size()]);
    play(mappings.egos[choice - mappings.radars.size()], decoder, frames);
  }
  return 0;
}
