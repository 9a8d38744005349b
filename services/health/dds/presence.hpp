// Which sources of a topic are present: pure, with the time as argument.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boresight::dds {

/// Why the last sample of a source is no longer the truth.
enum class Absence : std::uint8_t {
  kNone,        ///< it is present
  kDeadline,    ///< no sample within the requested deadline
  kLiveliness,  ///< no sign of life of any writer within the requested lease
  kEnded,       ///< the writer ended in order and disposed its instances
  kNoWriter,    ///< the last writer left
  kRefused,     ///< a writer exists, but offers less than the reader requests
};

/// A source became absent or is present again.
struct Presence {
  std::string topic;
  std::string source;   ///< a radar, "system", or the topic itself
  std::string vehicle;  ///< "": not known
  Absence absence = Absence::kNone;
  std::int64_t silent_ns = 0;  ///< since the last sample
};

/// The sources of one topic. `Key` is the middleware's handle of an instance.
template <typename Key>
class PresenceWatch {
 public:
  /// Watches `most_sources` at most, so that a hostile writer cannot fill the memory; further ones are not watched.
  PresenceWatch(std::string topic, std::size_t most_sources) : topic_(std::move(topic)), most_sources_(most_sources) {}

  /// A sample arrived. Returns the change if the source was absent before. A source that is new is no change.
  std::optional<Presence> received(const Key& key, const std::string& source, const std::string& vehicle,
                                   std::int64_t now_ns) {
    auto found = sources_.find(key);
    if (found == sources_.end()) {
      if (sources_.size() >= most_sources_) return std::nullopt;
      found = sources_.emplace(key, Source{}).first;
    }
    Source& known = found->second;
    std::optional<Presence> change;
    if (known.absence != Absence::kNone) {
      change = Presence{topic_, source, vehicle, Absence::kNone, now_ns - known.received_ns};
    }
    known = {source, vehicle, Absence::kNone, now_ns};
    return change;
  }

  /// One source is absent. Returns the change, or nothing if it is not known or was absent before.
  std::optional<Presence> absent(const Key& key, Absence absence, std::int64_t now_ns) {
    const auto found = sources_.find(key);
    if (found == sources_.end() || found->second.absence != Absence::kNone) return std::nullopt;
    Source& known = found->second;
    known.absence = absence;
    return Presence{topic_, known.name, known.vehicle, absence, now_ns - known.received_ns};
  }

  /// All sources are absent. Returns a change for each that was present.
  std::vector<Presence> all_absent(Absence absence, std::int64_t now_ns) {
    std::vector<Presence> changes;
    for (const auto& [key, known] : sources_) {
      if (auto change = absent(key, absence, now_ns)) changes.push_back(std::move(*change));
    }
    return changes;
  }

  /// The writers offer less than is requested. Returns the change the first time.
  std::optional<Presence> refused() {
    if (std::exchange(is_refused_, true)) return std::nullopt;
    return Presence{topic_, topic_, {}, Absence::kRefused, 0};
  }

 private:
  struct Source {
    std::string name;
    std::string vehicle;
    Absence absence = Absence::kNone;
    std::int64_t received_ns = 0;
  };
  std::string topic_;
  std::size_t most_sources_;
  std::map<Key, Source> sources_;
  bool is_refused_ = false;
};

}  // namespace boresight::dds
