#include "services/ingest_gateway/mapping/mapping_file.hpp"

#include "services/common/runtime/config/read_text.hpp"

namespace boresight::ingest {

namespace {

namespace fs = std::filesystem;

/// The database beside a mapping file: `name` is absolute or relative to the mapping file's folder.
dbc::Database load_beside(const fs::path& mapping_file, const std::string& name) {
  const fs::path file = mapping_file.parent_path() / name;
  return dbc::parse_dbc(config::read_text(file, config::kMaxDatabaseBytes), file.string());
}

}  // namespace

dbc::RadarMapping read_radar_mapping(const fs::path& file) {
  return read_radar_mapping(config::Reader::open(file),
                            [&](const std::string& name) { return load_beside(file, name); });
}

dbc::EgoMapping read_ego_mapping(const fs::path& file) {
  return read_ego_mapping(config::Reader::open(file), [&](const std::string& name) { return load_beside(file, name); });
}

}  // namespace boresight::ingest
