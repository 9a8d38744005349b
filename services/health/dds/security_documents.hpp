// The two documents of DDS Security: what is protected in a domain, and what a participant may do. Text in, findings
// out.
#pragma once

#include <cstdint>
#include <string>

namespace boresight::dds {

/// Why a governance document does not protect the domain; empty if it does. Protected: only participants with a
/// certificate and permissions take part, each topic needs a right, and every message is encrypted or signed.
[[nodiscard]] std::string problem_of_governance(const std::string& xml, std::uint32_t domain);

/// What a permissions document grants one participant.
struct Grant {
  std::string problem;            ///< why there is no grant; empty if there is
  std::int64_t not_before_s = 0;  ///< since the epoch
  std::int64_t not_after_s = 0;
};

/// The first grant for a subject (RFC 2253) with an allowing rule for the domain. Times of the document are local
/// times, as the middleware reads them.
[[nodiscard]] Grant grant_of(const std::string& xml, const std::string& subject, std::uint32_t domain);
[[nodiscard]] std::string problem_of_validity(const Grant& grant, std::int64_t now_s);

}  // namespace boresight::dds
