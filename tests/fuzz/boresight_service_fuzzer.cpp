// Fuzzer of the Boresight service's event bodies: detection lists and ego motions. The first byte chooses whether the
// header is corrected for the length of the rest, so that the fuzzer passes the header.
#include <vector>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/codecs/boresight_service.hpp"
#include "tests/fuzz/checked_output.hpp"

namespace {

using namespace boresight;
namespace list = wire::boresight_service::detection_list;
namespace ego = wire::boresight_service::ego_motion;

/// The header and record lengths are chosen by the first two bytes; the body is cut to whole records.
void make_list_agree(std::vector<std::uint8_t>& body) {
  if (body.size() < list::kMinHeaderBytes + 4) return;
  const std::size_t header_bytes = list::kMinHeaderBytes + body[0] % 2 * 4u;
  const std::size_t record_bytes = list::kMinRecordBytes + body[1] % 2 * 4u;
  const std::size_t count = (body.size() - header_bytes) / record_bytes;
  body.resize(header_bytes + count * record_bytes);
  body.shrink_to_fit();  // so that the sanitizer finds a read beyond its end
  boresight::write_u16(body.data() + list::kLayoutVersion, list::kLayoutVersionValue);
  boresight::write_u16(body.data() + list::kHeaderBytes, static_cast<std::uint16_t>(header_bytes));
  boresight::write_u16(body.data() + list::kNumberOfDetections, static_cast<std::uint16_t>(count));
  boresight::write_u16(body.data() + list::kRecordBytes, static_cast<std::uint16_t>(record_bytes));
}

void make_ego_agree(std::vector<std::uint8_t>& body) {
  if (body.size() < ego::kMinBodyBytes) return;
  boresight::write_u16(body.data() + ego::kLayoutVersion, ego::kLayoutVersionValue);
  boresight::write_u16(body.data() + ego::kBodyBytes, static_cast<std::uint16_t>(body.size()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const std::uint8_t choice = input.u8();
  const bool is_list = (choice & 1) != 0;
  std::vector<std::uint8_t> body(input.rest().begin(), input.rest().end());
  if ((choice & 2) != 0) is_list ? make_list_agree(body) : make_ego_agree(body);
  recording::Frame frame;
  frame.kind = recording::FrameKind::kUdp;
  frame.payload = body;
  fuzz::CheckedOutput output;
  ingest::service::DetectionList detections;
  ingest::service::EgoEvent motion;
  const fuzz::NoAllocation guard;
  const ingest::FrameStamp stamp{1'000'000'000, 1'700'000'000'000'000'000, TimeSource::kLinkArrival};
  is_list ? detections.take(frame, stamp, output) : motion.take(frame, stamp, output);
  output.require_at_rest();
  return 0;
}
