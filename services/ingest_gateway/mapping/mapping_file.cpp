#include "services/ingest_gateway/mapping/mapping_file.hpp"

#include <fstream>
#include <sstream>

namespace boresight::ingest {

namespace {

namespace fs = std::filesystem;

/// The database beside a mapping file: `name` is absolute or relative to the mapping file's folder.
dbc::Database load_beside(const fs::path& mapping_file, const std::string& name) {
  constexpr std::uintmax_t kMostBytes = 64u << 20;
  const fs::path file = mapping_file.parent_path() / name;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);  // also fails for folders
  if (error) throw config::Error(file.string() + " cannot be read: " + error.message());
  if (size > kMostBytes) throw config::Error(file.string() + " is larger than 64 MB");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw config::Error(file.string() + " cannot be read");
  return dbc::parse_dbc(text.str(), file.string());
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
