// The catalogue as text: a table for the terminal; a table and a diagram for the documentation.
#pragma once

#include <string>

namespace boresight::catalogue {

/// Columns: topic, type, size, writer, readers, period, deadline, queue, history.
[[nodiscard]] std::string to_table();
/// The same table in Markdown, then a Mermaid flow chart of services and topics (without the monitor, which reads all).
[[nodiscard]] std::string to_markdown();

}  // namespace boresight::catalogue
