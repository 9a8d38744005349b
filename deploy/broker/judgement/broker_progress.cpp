#include "deploy/broker/judgement/broker_progress.hpp"

#include <algorithm>

namespace boresight::broker {

namespace {

bool is_short_of_resources(const ThreadActivity& thread) {
  return thread.state == ThreadState::kRunnable || thread.state == ThreadState::kOnDisk;
}

std::string words_of(Wait wait) {
  switch (wait) {
    case Wait::kMutexOfTheDead:
      return " waits for a mutex of an ended process since ";
    case Wait::kMutexOfAnother:
      return " waits for a mutex of a living process since ";
    case Wait::kOther:
      return " sleeps since ";
    case Wait::kUnknown:
      break;
  }
  return " waits for a mutex, or sleeps, since ";
}

std::string tenths_of_seconds(std::int64_t duration_ns) {
  constexpr std::int64_t kTenth_ns = 100'000'000;
  const std::int64_t tenths = duration_ns / kTenth_ns;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

}  // namespace

void BrokerProgress::observe(std::int64_t time_ns, const std::vector<ThreadActivity>& threads) {
  const std::int64_t passed_ns = last_ns_ ? std::clamp<std::int64_t>(time_ns - *last_ns_, 0, kObservationPeriod_ns) : 0;
  last_ns_ = time_ns;
  is_judgeable_ = false;
  sees_waits_ = true;
  const bool short_of_resources = std::any_of(threads.begin(), threads.end(), is_short_of_resources);
  for (const ThreadActivity& thread : threads) {
    if (thread.name != kMessageThread && thread.name != kDiscoveryThread) continue;
    is_judgeable_ = true;
    if (thread.state == ThreadState::kSleeping && thread.wait == Wait::kUnknown) sees_waits_ = false;
    const auto [entry, is_new] = silences_.try_emplace(thread.name);
    Silence& silence = entry->second;
    const bool has_progressed = is_new || thread.voluntary_switches != silence.voluntary_switches;
    if (has_progressed) {
      silence = {.voluntary_switches = thread.voluntary_switches, .busy_since_ns = thread.processor_time_ns};
    } else if (!short_of_resources) {
      silence.asleep_ns += passed_ns;
    }
    silence.busy_ns = thread.processor_time_ns - silence.busy_since_ns;
    silence.is_stopped = thread.state == ThreadState::kStopped;
    silence.wait = thread.wait;
  }
}

std::int64_t BrokerProgress::limit_ns(const Silence& silence) const {
  const bool may_lack_a_processor =
      !silence.is_stopped && (silence.wait == Wait::kMutexOfAnother || silence.wait == Wait::kOther);
  return may_lack_a_processor ? limits_.starved_ns : limits_.asleep_ns;
}

std::optional<std::string> BrokerProgress::hung() const {
  for (const auto& [name, silence] : silences_) {
    const std::string thread = "thread " + name;
    if (silence.asleep_ns >= limit_ns(silence)) {
      return thread + (silence.is_stopped ? " is stopped since " : words_of(silence.wait)) +
             tenths_of_seconds(silence.asleep_ns);
    }
    if (silence.busy_ns >= limits_.busy_ns) {
      return thread + " runs without a pause since " + tenths_of_seconds(silence.busy_ns);
    }
  }
  return std::nullopt;
}

}  // namespace boresight::broker
