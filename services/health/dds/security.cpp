#include "services/health/dds/security.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <stdexcept>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastrtps/config.h>

#include "services/health/dds/certificates.hpp"
#include "services/health/dds/security_documents.hpp"

namespace boresight::dds {

namespace {

namespace fs = std::filesystem;
namespace fast = eprosima::fastdds::dds;

/// A file of the configuration, with the name of its key.
struct Named {
  std::string key;
  fs::path file;
  std::string text;

  [[noreturn]] void refuse(const std::string& reason) const {
    throw std::runtime_error("dds.security." + key + ": " + file.string() + ": " + reason);
  }
  void refuse_if(const std::string& reason) const {
    if (!reason.empty()) refuse(reason);
  }
};

fs::path place_of(const SecurityConfig& config, const std::string& name) {
  return fs::path(config.directory) / name;  // an absolute name replaces the directory
}

Named named(const SecurityConfig& config, const std::string& key, const std::string& name) {
  if (name.empty()) throw std::runtime_error("dds.security." + key + ": no file is named");
  Named result{key, place_of(config, name), {}};
  if (!result.file.is_absolute() && config.directory.empty()) {
    throw std::runtime_error("dds.security.directory: is missing, and " + key + " is no absolute path");
  }
  std::string problem;
  result.text = read_security_file(result.file, key == "private_key", problem);
  result.refuse_if(problem);
  return result;
}

Certificate valid_certificate(const Named& file, std::int64_t now_s, std::int64_t& until_s) {
  Certificate certificate(file.text);
  if (!certificate) file.refuse("holds no certificate in PEM format");
  file.refuse_if(certificate.problem_of_validity(now_s));
  until_s = std::min(until_s, certificate.not_after_s());
  return certificate;
}

std::string signed_content(const Named& file, const Certificate& authority, std::int64_t now_s) {
  std::string problem;
  std::string content = content_signed_by(authority, file.text, now_s, problem);
  file.refuse_if(problem);
  return content;
}

/// Throws std::runtime_error with the problem. Returns the first end of a validity.
std::int64_t check_all(const SecurityConfig& config, std::uint32_t domain, std::int64_t now_s) {
  const Named identity_ca_file = named(config, "identity_ca", config.identity_ca);
  const Named certificate_file = named(config, "certificate", config.certificate);
  const Named key_file = named(config, "private_key", config.private_key);
  const Named permissions_ca_file = named(config, "permissions_ca", config.permissions_ca);
  const Named governance_file = named(config, "governance", config.governance);
  const Named permissions_file = named(config, "permissions", config.permissions);

  std::int64_t until_s = INT64_MAX;
  const Certificate identity_ca = valid_certificate(identity_ca_file, now_s, until_s);
  const Certificate certificate = valid_certificate(certificate_file, now_s, until_s);
  const Certificate permissions_ca = valid_certificate(permissions_ca_file, now_s, until_s);
  certificate_file.refuse_if(certificate.problem_of_issuer(identity_ca, now_s));
  key_file.refuse_if(certificate.problem_of_key(key_file.text));
  // The middleware takes a document as signed if any certificate of this authority signed it.
  if (certificate.problem_of_issuer(permissions_ca, now_s).empty()) {
    permissions_ca_file.refuse("has also issued the certificate, whose owner could sign permissions for itself");
  }
  governance_file.refuse_if(problem_of_governance(signed_content(governance_file, permissions_ca, now_s), domain));
  const Grant grant = grant_of(signed_content(permissions_file, permissions_ca, now_s), certificate.subject(), domain);
  permissions_file.refuse_if(grant.problem.empty() ? problem_of_validity(grant, now_s) : grant.problem);
  return std::min(until_s, grant.not_after_s);
}

}  // namespace

SecurityState check_security(const SecurityConfig& config, std::uint32_t domain, std::int64_t now_s) {
  SecurityState state;
  if (!config.enabled) return state;
  try {
    state.valid_until_s = check_all(config, domain, now_s);
  } catch (const std::runtime_error& error) {
    state.problem = error.what();
    state.valid_until_s = 0;
  }
  return state;
}

void secure(fast::DomainParticipantQos& qos, const SecurityConfig& config, std::uint32_t domain) {
  if (!config.enabled) return;
#if !HAVE_SECURITY
  throw std::runtime_error("dds.security.enabled: this Fast DDS is built without security");
#endif
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const SecurityState state =
      check_security(config, domain, std::chrono::duration_cast<std::chrono::seconds>(now).count());
  if (!state.problem.empty()) throw std::runtime_error(state.problem);
  auto& properties = qos.properties().properties();
  const auto set = [&properties](const char* name, const std::string& value) { properties.emplace_back(name, value); };
  const auto file = [&config](const std::string& name) {
    return "file://" + fs::absolute(place_of(config, name)).string();
  };
  set("dds.sec.auth.plugin", "builtin.PKI-DH");
  set("dds.sec.auth.builtin.PKI-DH.identity_ca", file(config.identity_ca));
  set("dds.sec.auth.builtin.PKI-DH.identity_certificate", file(config.certificate));
  set("dds.sec.auth.builtin.PKI-DH.private_key", file(config.private_key));
  set("dds.sec.access.plugin", "builtin.Access-Permissions");
  set("dds.sec.access.builtin.Access-Permissions.permissions_ca", file(config.permissions_ca));
  set("dds.sec.access.builtin.Access-Permissions.governance", file(config.governance));
  set("dds.sec.access.builtin.Access-Permissions.permissions", file(config.permissions));
  set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
}

}  // namespace boresight::dds
