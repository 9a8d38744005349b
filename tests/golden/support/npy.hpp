// Reads the arrays of doubles beside the recording.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace boresight::golden {

/// All numbers of a version 1 .npy file of little-endian doubles, in file order. Throws for any other format.
inline std::vector<double> read_npy(const std::filesystem::path& path, const std::string& order = "False") {
  std::ifstream file(path, std::ios::binary);
  unsigned char start[10] = {};
  file.read(reinterpret_cast<char*>(start), sizeof(start));
  if (!file || start[0] != 0x93 || start[1] != 'N' || start[6] != 1) throw std::runtime_error(path.string());
  std::string header(static_cast<std::size_t>(start[8] | start[9] << 8), ' ');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (header.find("'<f8'") == std::string::npos || header.find("'fortran_order': " + order) == std::string::npos) {
    throw std::runtime_error(path.string() + ": " + header);
  }
  std::vector<double> values;
  for (double value = 0.0; file.read(reinterpret_cast<char*>(&value), sizeof(value));) values.push_back(value);
  return values;
}

/// The same for a file in column order.
inline std::vector<double> read_npy_columns(const std::filesystem::path& path) {
  return read_npy(path, "True");
}

/// Linear interpolation in (times, values); constant beyond the ends.
inline double at(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return values.front();
  if (after == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

}  // namespace boresight::golden
