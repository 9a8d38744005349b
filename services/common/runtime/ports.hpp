// Typed ports over iceoryx. Only this header and node.hpp depend on the middleware, so that another one can replace it.
// The catalogue gives queue depths and history; a writer or reader that the catalogue does not list is refused.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/header.hpp"

namespace boresight::runtime {

class Node;

/// Source and times of a message that does not derive from another message.
struct Origin {
  std::uint32_t source_id = 0;
  std::int64_t measurement_time_ns = 0;
  TimeSource time_source = TimeSource::kUnknown;
  std::optional<Stage> stage;  ///< the stage to stamp, if the message derives from a radar scan
  std::int64_t begin_ns = 0;   ///< when this stage got its input; used with `stage`
};

namespace detail {
struct PublisherPort;  // iceoryx's untyped publisher and the sequence counters
struct PublisherPortDeleter {
  void operator()(PublisherPort*) const;
};
/// Returns nullptr, and counts Fault::kLoanFailed, if the pool is exhausted.
[[nodiscard]] void* loan(PublisherPort&);
void release(PublisherPort&, void* payload);
void send(PublisherPort&, void* payload, std::uint32_t version, const Origin&, const MessageHeader* upstream);
[[nodiscard]] std::unique_ptr<PublisherPort, PublisherPortDeleter> open_publisher(Node&, const catalogue::Topic&);
}  // namespace detail

/// A chunk of shared memory that this process may write until it is published or dropped. It still has the content of
/// an earlier message; publishing writes the header.
template <typename T>
class Loan {
 public:
  Loan() = default;
  Loan(detail::PublisherPort* port, T* payload) : port_(port), payload_(payload) {}
  Loan(Loan&& other) noexcept
      : port_(std::exchange(other.port_, nullptr)), payload_(std::exchange(other.payload_, nullptr)) {}
  Loan& operator=(Loan&& other) noexcept {
    if (this != &other) {
      drop();
      port_ = std::exchange(other.port_, nullptr);
      payload_ = std::exchange(other.payload_, nullptr);
    }
    return *this;
  }
  ~Loan() { drop(); }
  explicit operator bool() const { return payload_ != nullptr; }
  T& operator*() const { return *payload_; }
  T* operator->() const { return payload_; }
  [[nodiscard]] T* take() { return std::exchange(payload_, nullptr); }

 private:
  void drop() {
    if (payload_ != nullptr) detail::release(*port_, payload_);
    payload_ = nullptr;
  }
  detail::PublisherPort* port_ = nullptr;
  T* payload_ = nullptr;
};

/// Writes messages of type T. The constructor throws std::logic_error if the catalogue does not list this service as
/// a writer of T's topic.
template <typename T>
class Publisher {
 public:
  explicit Publisher(Node& node) : port_(detail::open_publisher(node, catalogue::topic(catalogue::kTopicOf<T>))) {}

  /// An empty loan if the pool is exhausted, which is counted as a fault.
  [[nodiscard]] Loan<T> loan() { return Loan<T>(port_.get(), static_cast<T*>(detail::loan(*port_))); }

  /// Writes version, sequence numbers, source and stamps into the header and passes the chunk to the readers.
  void publish(Loan<T>&& chunk, const Origin& origin) {
    if (chunk) detail::send(*port_, chunk.take(), T::kVersion, origin, nullptr);
  }

  /// For a message that derives from `upstream`, with its source, measurement time and stamps of earlier stages. This
  /// stage begins when the node calls the handler with `upstream`. `fill(T&)` writes everything except the header.
  /// Returns false if no chunk is available.
  template <typename Fill>
  bool publish_from(const MessageHeader& upstream, Stage stage, Fill&& fill) {
    Loan<T> chunk = loan();
    if (!chunk) return false;
    fill(*chunk);
    Origin origin{upstream.source_id, upstream.measurement_time_ns, upstream.time_source, stage, 0};
    detail::send(*port_, chunk.take(), T::kVersion, origin, &upstream);
    return true;
  }

  /// For other messages: `fill(T&)` writes everything except the header.
  template <typename Fill>
  bool publish(const Origin& origin, Fill&& fill) {
    Loan<T> chunk = loan();
    if (!chunk) return false;
    fill(*chunk);
    publish(std::move(chunk), origin);
    return true;
  }

 private:
  std::unique_ptr<detail::PublisherPort, detail::PublisherPortDeleter> port_;
};

}  // namespace boresight::runtime
