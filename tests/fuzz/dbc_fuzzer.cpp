// Any text as a DBC file. The result must be usable without a further check.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "services/ingest_gateway/dbc/dbc.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boresight;
  using namespace boresight::ingest;
  const dbc::Database database = dbc::parse_dbc({reinterpret_cast<const char*>(data), size}, "fuzz.dbc");
  for (const dbc::Message& message : database.messages) {
    const std::vector<std::uint8_t> payload(message.length_bytes, 0xA5);
    for (const dbc::Signal& signal : message.signals) {
      if (!wire::fits(signal.can_signal(), payload.size())) std::abort();
      static_cast<void>(wire::extract(signal.can_signal(), payload));
      std::size_t switches = 0;
      for (const dbc::Signal* at = &signal; at->is_multiplexed(); at = &message.signals.at(at->switch_index)) {
        if (++switches > dbc::kMaxSwitches || at->switch_values.empty()) std::abort();
      }
    }
  }
  if (database.problems.size() > dbc::kMaxProblems) std::abort();
  return 0;
}
