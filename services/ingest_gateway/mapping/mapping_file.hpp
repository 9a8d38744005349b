// Mapping files (config/schema/mapping.md): assign the signals of a DBC file to a radar or to ego motion.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/dbc/dbc.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

/// Reads a mapping file and the DBC file that it names, and resolves every name. Throws config::Error with a line for
/// each error, "file:line: key: problem". Lines of the DBC file that could not be used are in `warnings`.
[[nodiscard]] dbc::RadarMapping read_radar_mapping(const std::filesystem::path& file);
[[nodiscard]] dbc::EgoMapping read_ego_mapping(const std::filesystem::path& file);

/// Returns the database for the text of the key `dbc`; throws config::Error on failure.
using LoadDatabase = std::function<dbc::Database(const std::string&)>;

/// The same for an open document and a function that returns the database.
[[nodiscard]] dbc::RadarMapping read_radar_mapping(config::Reader root, const LoadDatabase& load);
[[nodiscard]] dbc::EgoMapping read_ego_mapping(config::Reader root, const LoadDatabase& load);

}  // namespace boresight::ingest
