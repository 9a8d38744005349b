#include "services/common/runtime/boot_time.hpp"

#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

#include "services/common/state/fingerprint.hpp"

namespace boresight::runtime {

std::uint64_t boot_fingerprint() {
  std::ifstream stream("/proc/sys/kernel/random/boot_id", std::ios::binary);
  const std::string id{std::istreambuf_iterator<char>(stream), {}};
  state::Fingerprint print;
  print.add(std::string_view(id));
  return id.empty() ? 0 : print.value();
}

double seconds_between(const BootTime& then, const BootTime& now) {
  const bool known = then.boot != 0 && then.boot == now.boot && then.since_boot_ns <= now.since_boot_ns;
  return known ? 1e-9 * static_cast<double>(now.since_boot_ns - then.since_boot_ns)
               : std::numeric_limits<double>::infinity();
}

}  // namespace boresight::runtime
