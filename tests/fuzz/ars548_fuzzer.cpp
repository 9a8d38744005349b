// Fuzzer of the ARS548 codecs: detection lists, object lists and status. The first byte chooses a message and its
// length; the rest of the input becomes its content, so that the fuzzer passes the header. One choice passes the input
// unchanged.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "interfaces/wire/ars548.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/ingest_gateway/codecs/ars548_objects.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using fuzz::require;
namespace layout = wire::ars548;

void require_possible(const RadarScan& scan) {
  require(scan.number_of_valid_detections <= layout::kMaxDetectionRecords);
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    require(scan.azimuth_std_rad[i] >= 0.0F && std::isfinite(scan.range_std_m[i]));
    if ((scan.detection_flags[i] & detection_flag::kUntrusted) != 0) continue;
    require(scan.range_m[i] >= 0.0F && scan.range_m[i] <= 1500.0F && std::abs(scan.range_rate_mps[i]) <= 150.0F);
  }
}

void require_possible(const ingest::ars548::ObjectList& list, std::size_t most) {
  require(list.number_of_objects <= most);
  for (std::size_t i = 0; i < list.number_of_objects; ++i) {
    const ingest::ars548::Object& o = list.objects[i];
    require(std::isfinite(o.length_m) && std::isfinite(o.width_m) && std::isfinite(o.orientation_rate_radps));
    require(!o.valid || (std::abs(o.x_m) <= 1600.0F && o.existence_probability <= 1.0F && o.x_std_m >= 0.0F));
    require(!o.relative_velocity_mps.valid || std::isfinite(o.relative_velocity_mps.x));
  }
}

struct Kind {
  std::uint16_t method;
  std::size_t bytes;
};
constexpr Kind kKinds[] = {{layout::kMethodDetectionList, layout::kDetectionListBytes},
                           {layout::kMethodObjectList, layout::kObjectListBytes},
                           {layout::kMethodObjectList, layout::kLongObjectListBytes},
                           {layout::kMethodStatus, layout::kStatusBytes}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  if (size == 0) return 0;
  std::vector<std::uint8_t> datagram(input + 1, input + size);
  if (const std::size_t choice = input[0] % 5; choice < 4) {
    const Kind& kind = kKinds[choice];
    datagram.insert(datagram.begin(), layout::kShortHeaderBytes, 0);
    datagram.resize(kind.bytes);
    boresight::write_u16(datagram.data() + 2, kind.method);
    boresight::write_u32(datagram.data() + 4, static_cast<std::uint32_t>(kind.bytes - layout::kShortHeaderBytes));
    // The count is after all records, beyond the end of a short input.
    if (choice == 0) boresight::write_u32(datagram.data() + layout::kNumberOfDetections, 3u * input[0]);
  }
  static const auto scan = std::make_unique<RadarScan>();
  static const auto objects = std::make_unique<ingest::ars548::ObjectList>();
  const fuzz::NoAllocation guard;
  std::string_view problem;
  const ingest::DecodeResult result = ingest::ars548::check(datagram, problem);
  require(!ingest::fault_of(result) || !problem.empty());
  if (result == ingest::DecodeResult::kComplete) {
    static_cast<void>(ingest::ars548::decode(datagram, *fuzz::stale(*scan)));
    scan->integrity = 0;  // written by others
    fuzz::require_possible(*scan);
    require_possible(*scan);
  }
  if (result == ingest::DecodeResult::kAccepted) require(ingest::ars548::conditions(datagram) < 1u << 7);
  if (ingest::ars548::check_objects(datagram, problem) == ingest::DecodeResult::kComplete) {
    ingest::ars548::decode_objects(datagram, *objects);
    require_possible(*objects, datagram.size() == layout::kObjectListBytes ? 50 : 200);
  }
  return 0;
}
