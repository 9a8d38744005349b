#include "tests/benchmarks/pipeline_latency/bare_chain.hpp"

#include <array>
#include <memory>
#include <string>

#include <iceoryx_posh/popo/untyped_publisher.hpp>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "tests/system/harness/child.hpp"
#include "tests/system/harness/roudi.hpp"

namespace boresight::bench {

namespace {

constexpr std::size_t kMaxMessages = 100'000;

struct Result {
  volatile std::size_t size;
  std::array<double, kMaxMessages> latency_ns;
};

iox::capro::IdString_t id(const std::string& text) {
  return {iox::cxx::TruncateToCapacity, text.c_str(), text.size()};
}

iox::capro::ServiceDescription link(std::size_t hop) {
  return {id("bench"), id("hop"), id(std::to_string(hop))};
}

void connect(const std::string& name) {
  runtime::install_stop_signals();
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, name.c_str(), name.size()));
}

void send(iox::popo::UntypedPublisher& port, std::size_t bytes, std::int64_t begin_ns) {
  auto chunk = port.loan(static_cast<std::uint32_t>(bytes), 64);
  if (chunk.has_error()) return;
  *static_cast<std::int64_t*>(chunk.value()) = begin_ns;
  port.publish(chunk.value());
}

/// Forwards the stamp of each message from link `hop` to the next in a chunk of `bytes`, or notes it at the end.
int forward(std::size_t hop, std::size_t bytes, Result* end) {
  connect("bench-" + std::to_string(hop));
  iox::popo::UntypedSubscriber input(link(hop));
  std::unique_ptr<iox::popo::UntypedPublisher> output;
  if (end == nullptr) output = std::make_unique<iox::popo::UntypedPublisher>(link(hop + 1));
  iox::popo::WaitSet<> waitset;
  waitset.attachState(input, iox::popo::SubscriberState::HAS_DATA).or_else([](auto) { std::abort(); });
  while (!runtime::stop_signalled()) {
    static_cast<void>(waitset.timedWait(iox::units::Duration::fromMilliseconds(50)));
    for (auto taken = input.take(); !taken.has_error(); taken = input.take()) {
      const std::int64_t begin_ns = *static_cast<const std::int64_t*>(taken.value());
      if (end == nullptr) {
        send(*output, bytes, begin_ns);
      } else if (end->size < kMaxMessages) {
        end->latency_ns[end->size] = static_cast<double>(runtime::monotonic_now_ns() - begin_ns);
        end->size = end->size + 1;
      }
      input.release(taken.value());
    }
  }
  return 0;
}

}  // namespace

std::vector<double> bare_chain(const std::vector<std::size_t>& chunk_bytes, std::int64_t period_ns,
                               std::size_t messages) {
  const harness::Roudi roudi;
  harness::Shared<Result> result;
  std::vector<std::unique_ptr<harness::Child>> hops;
  for (std::size_t hop = 0; hop < chunk_bytes.size(); ++hop) {
    const bool last = hop + 1 == chunk_bytes.size();
    hops.push_back(std::make_unique<harness::Child>(
        [&, hop, last] { return forward(hop, last ? 0 : chunk_bytes[hop + 1], last ? &*result : nullptr); }));
  }
  harness::sleep_s(0.5);
  harness::Child source([&] {
    connect("bench-source");
    iox::popo::UntypedPublisher output(link(0));
    harness::sleep_s(0.2);
    for (std::size_t i = 0; i < messages && !runtime::stop_signalled(); ++i) {
      send(output, chunk_bytes.front(), runtime::monotonic_now_ns());
      harness::sleep_s(static_cast<double>(period_ns) * 1e-9);
    }
    return 0;
  });
  static_cast<void>(source.wait_for(10.0 + 2e-9 * static_cast<double>(period_ns) * static_cast<double>(messages)));
  for (auto& hop : hops) static_cast<void>(hop->stop());
  return {result->latency_ns.begin(), result->latency_ns.begin() + static_cast<std::ptrdiff_t>(result->size)};
}

}  // namespace boresight::bench
