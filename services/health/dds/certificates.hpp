// Certificates, keys and signed documents of DDS Security, by OpenSSL.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

struct x509_st;

namespace boresight::dds {

/// The content of a regular file of limited size. `is_secret`: others than owner and group must not have access. On
/// failure returns an empty text, and `problem` states the reason.
[[nodiscard]] std::string read_security_file(const std::filesystem::path& file, bool is_secret, std::string& problem);

/// The functions problem_of_… return a reason, or an empty text. Times are in seconds since the epoch.
class Certificate {
 public:
  /// The first certificate of a text in PEM format; false if there is none.
  explicit Certificate(const std::string& pem);
  explicit operator bool() const { return certificate_ != nullptr; }

  [[nodiscard]] std::string problem_of_validity(std::int64_t now_s) const;
  [[nodiscard]] std::int64_t not_after_s() const;
  /// Whether that authority has issued this certificate.
  [[nodiscard]] std::string problem_of_issuer(const Certificate& authority, std::int64_t now_s) const;
  /// Whether a private key in PEM format, without a password, belongs to this certificate.
  [[nodiscard]] std::string problem_of_key(const std::string& pem) const;
  /// Name of the subject by RFC 2253: "CN=health,OU=vehicle,O=Boresight".
  [[nodiscard]] std::string subject() const;
  [[nodiscard]] x509_st* get() const { return certificate_.get(); }

 private:
  std::shared_ptr<x509_st> certificate_;
};

/// The content of an S/MIME document that the authority itself has signed. On failure returns an empty text, and
/// `problem` states the reason.
[[nodiscard]] std::string content_signed_by(const Certificate& authority, const std::string& document,
                                            std::int64_t now_s, std::string& problem);

}  // namespace boresight::dds
