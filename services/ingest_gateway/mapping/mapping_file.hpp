// Mapping files (config/schema/mapping.md): what the signals of a DBC file mean to a radar or to ego motion.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/dbc/dbc.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

/// Reads a mapping file and the DBC file that it names, and looks up every name. Throws config::Error with a line for
/// each error, "file:line: key: problem". Lines of the DBC file that could not be used are in `warnings`.
[[nodiscard]] dbc::RadarMapping read_radar_mapping(const std::filesystem::path& file);
[[nodiscard]] dbc::EgoMapping read_ego_mapping(const std::filesystem::path& file);

/// Gives the database for the text of the key `dbc`; throws config::Error if it cannot.
using LoadDatabase = std::function<dbc::Database(const std::string&)>;

/// The same from a document and a database that are there already.
[[nodiscard]] dbc::RadarMapping read_radar_mapping(config::Reader root, const LoadDatabase& load);
[[nodiscard]] dbc::EgoMapping read_ego_mapping(config::Reader root, const LoadDatabase& load);

}  // namespace boresight::ingest
