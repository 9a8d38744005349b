// The files with which a participant proves its identity and its rights (DDS Security). deploy/dds_security makes them.
#pragma once

#include <string>

namespace boresight::dds {

/// Names of files are relative to `directory`, or absolute.
struct SecurityConfig {
  bool enabled = false;                               ///< false: anybody on the network can read and publish
  std::string directory;                              ///< "": all names must be absolute
  std::string identity_ca = "identity_ca.pem";        ///< authority that issues the identities of all participants
  std::string certificate = "certificate.pem";        ///< identity of this participant
  std::string private_key = "private_key.pem";        ///< its key; others must not have access
  std::string permissions_ca = "permissions_ca.pem";  ///< authority that signs the two documents
  std::string governance = "governance.p7s";          ///< what is protected in the domain, signed
  std::string permissions = "permissions.p7s";        ///< what this participant may read and publish, signed
};

/// All files under their default names in `directory`.
[[nodiscard]] inline SecurityConfig secured_by(const std::string& directory) {
  SecurityConfig config;
  config.enabled = true;
  config.directory = directory;
  return config;
}

}  // namespace boresight::dds
