#include "services/simulator/wire/ars548_encoder.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/messages/service_status.hpp"
#include "services/simulator/wire/byte_writer.hpp"

namespace boresight::simulator::wire {

void encode_ars548(const RadarScan& scan, std::int64_t epoch_ns, Ars548List& bytes) {
  bytes.fill(0);
  put_u16(bytes, 0, 0);                                             // service
  put_u16(bytes, 2, 336);                                           // method: detection list
  put_u32(bytes, 4, static_cast<std::uint32_t>(bytes.size() - 8));  // length of what follows
  put_u32(bytes, 36, static_cast<std::uint32_t>(epoch_ns % 1'000'000'000));
  put_u32(bytes, 40, static_cast<std::uint32_t>(epoch_ns / 1'000'000'000));
  bytes[44] = 1;  // synchronised
  const std::uint32_t count = std::min<std::uint32_t>(scan.number_of_valid_detections, 800);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t at = 101 + 44 * static_cast<std::size_t>(i);
    put_f32(bytes, at + 0, scan.azimuth_rad[i]);
    put_f32(bytes, at + 4, scan.azimuth_std_rad[i]);
    // One bit for each quantity; the sensor's doubt is put on the range rate. The list has no bit for ambiguity.
    const bool invalid = (scan.detection_flags[i] & detection_flag::kInvalid) != 0;
    bytes[at + 8] = static_cast<std::uint8_t>(invalid ? 1U << 6 : 0U);
    put_f32(bytes, at + 9, scan.elevation_rad[i]);
    put_f32(bytes, at + 13, scan.elevation_std_rad[i]);
    put_f32(bytes, at + 17, scan.range_m[i]);
    put_f32(bytes, at + 21, scan.range_std_m[i]);
    put_f32(bytes, at + 25, scan.range_rate_mps[i]);
    put_f32(bytes, at + 29, scan.range_rate_std_mps[i]);
    bytes[at + 33] = static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(scan.rcs_dbsm[i])));
    put_u16(bytes, at + 34, static_cast<std::uint16_t>(i));
    bytes[at + 36] = static_cast<std::uint8_t>(std::lround(100.0F * scan.existence_probability[i]));
    put_u16(bytes, at + 42, static_cast<std::uint16_t>(i));
  }
  put_f32(bytes, 35301, scan.range_rate_min_mps);
  put_f32(bytes, 35305, scan.range_rate_max_mps);
  put_u32(bytes, 35309, count);
}

Ars548Status encode_ars548_status(std::uint32_t condition) {
  Ars548Status bytes{};    // 0: inputs are received, voltage and temperature are in range
  put_u16(bytes, 2, 380);  // method: sensor status
  put_u32(bytes, 4, static_cast<std::uint32_t>(bytes.size() - 8));  // length of what follows
  bytes[16] = 1;                                                    // synchronised
  bytes[80] = 1;                                                    // in operation
  // Low half: 0 blind, 2 medium, 4 no blockage; high half: self-test passed.
  const bool blind = (condition & source_condition::kBlocked) != 0;
  const bool reduced = (condition & source_condition::kPartlyBlocked) != 0;
  bytes[83] = static_cast<std::uint8_t>(0x10 | (blind ? 0 : reduced ? 2 : 4));
  return bytes;
}

}  // namespace boresight::simulator::wire
