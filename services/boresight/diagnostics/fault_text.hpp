// Records of the fault memory, as lines for people or for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "generated/fault_memory.h"

namespace boresight::diagnostics_text {

/// The status byte in words: "failed, confirmed, pending", "passed, confirmed", "not tested in this cycle, confirmed".
[[nodiscard]] std::string status_text(std::uint8_t status);
/// A table with a row for each record and a head line; without records only what the head says.
[[nodiscard]] std::string fault_list(const std::vector<diagnostics::FaultRecord>& records, const std::string& head);
/// Everything of one record, a line for each quantity.
[[nodiscard]] std::string fault_page(const diagnostics::FaultRecord& record);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const diagnostics::FaultRecord& record);
/// All trouble codes as a Markdown table; "nn" stands for the number of a radar or service, in hexadecimal digits.
[[nodiscard]] std::string dtc_table();

}  // namespace boresight::diagnostics_text
