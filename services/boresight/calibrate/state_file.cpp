#include "services/boresight/calibrate/state_file.hpp"

#include <memory>
#include <stdexcept>

#include "services/alignment_estimator/core/memory/codec.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/alignment_estimator/store/memory_file.hpp"
#include "services/common/runtime/state_file.hpp"

namespace boresight::calibrate {

std::string seed_state_file(const std::filesystem::path& file, const VehicleConfig& vehicle,
                            const alignment::RotationSeed& seed) {
  using Kind = alignment::LoadedMemory::Kind;
  const Identity identity = identity_of(vehicle);
  const auto loaded = std::make_unique<alignment::LoadedMemory>(alignment::load_memory(file, identity));
  std::string note;
  switch (loaded->kind) {
    case Kind::kTaken:
      if (loaded->rejected_radars > 0) {
        note = file.string() + ": entries of radars whose nominal mounting has changed were rejected: " +
               std::to_string(loaded->rejected_radars);
      }
      break;
    case Kind::kUnreadable:
      throw std::runtime_error(file.string() + ": " + loaded->reason);
    case Kind::kRejected:
      note = file.string() + " was " + loaded->reason + "; it is kept as .rejected, and a new file is written";
      [[fallthrough]];
    case Kind::kMissing:
      // The initial state of the estimator.
      std::make_unique<alignment::WindowedFilter>(vehicle, alignment::FilterConfig{})->save(loaded->memory);
      break;
  }
  const auto bytes = std::make_unique<alignment::MemoryBytes>();
  if (!alignment::put_seed(seed, loaded->memory)) throw std::runtime_error(file.string() + ": no room for the radar");
  const std::size_t size = alignment::encode_memory(loaded->memory, identity, *bytes);
  if (size == 0) throw std::runtime_error(file.string() + ": radar " + std::to_string(seed.radar_id) + " is unknown");
  const std::string problem = runtime::write_state_file(file, std::span(bytes->data(), size));
  if (!problem.empty()) throw std::runtime_error(file.string() + ": " + problem);
  return note;
}

}  // namespace boresight::calibrate
