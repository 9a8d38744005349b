// A member of the domain that publishes without a pause, so that a kill hits it within publish(): a mutex in the shared
// memory is then locked for ever.
#include <cstdint>
#include <memory>
#include <vector>

#include <iceoryx_posh/popo/untyped_publisher.hpp>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <systemd/sd-daemon.h>

int main() {
  constexpr int kSubscribers = 8;  // the mutex is locked while all their queues are filled
  constexpr int kPublicationsPerStroke = 10'000;
  constexpr std::uint32_t kPayload_bytes = 64;
  iox::runtime::PoshRuntime::initRuntime("boresight-restless");
  const iox::capro::ServiceDescription topic("test", "dead", "mutex");
  iox::popo::SubscriberOptions options;
  options.queueCapacity = 1;
  std::vector<std::unique_ptr<iox::popo::UntypedSubscriber>> subscribers;
  for (int i = 0; i < kSubscribers; ++i) {
    subscribers.push_back(std::make_unique<iox::popo::UntypedSubscriber>(topic, options));
  }
  iox::popo::UntypedPublisher publisher(topic);
  sd_notify(0, "READY=1");
  for (;;) {
    for (int i = 0; i < kPublicationsPerStroke; ++i) {
      publisher.loan(kPayload_bytes).and_then([&](void* payload) { publisher.publish(payload); });
    }
    sd_notify(0, "WATCHDOG=1");
  }
}
