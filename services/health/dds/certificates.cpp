#include "services/health/dds/certificates.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::dds {

namespace {

constexpr std::size_t kLargestFile = 1 << 20;

template <auto free>
struct FreedBy {
  template <typename T>
  void operator()(T* thing) const {
    free(thing);
  }
};
using Bio = std::unique_ptr<BIO, FreedBy<BIO_free_all>>;
using Store = std::unique_ptr<X509_STORE, FreedBy<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, FreedBy<X509_STORE_CTX_free>>;
using Key = std::unique_ptr<EVP_PKEY, FreedBy<EVP_PKEY_free>>;
using Signed = std::unique_ptr<PKCS7, FreedBy<PKCS7_free>>;

Bio reading(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::string text_in(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return size > 0 ? std::string(data, static_cast<std::size_t>(size)) : std::string();
}

/// "Nov 30 22:07:37 2027 GMT"
std::string date_text(const ASN1_TIME* time) {
  const Bio out(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(out.get(), time);
  return text_in(out.get());
}

/// A store that trusts one certificate, and checks at a time of the caller's choice.
Store trusting(const Certificate& authority, std::int64_t now_s) {
  Store store(X509_STORE_new());
  X509_STORE_add_cert(store.get(), authority.get());
  X509_VERIFY_PARAM_set_time(X509_STORE_get0_param(store.get()), static_cast<std::time_t>(now_s));
  return store;
}

std::string latest_reason() {
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  return reason == nullptr ? "no reason is known" : reason;
}

/// Why the open file is not taken; empty if it is.
std::string refusal_of_file(int descriptor, bool is_secret) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "no regular file";
  if (is_secret && (status.st_mode & S_IRWXO) != 0) return "others have access to it; chmod o= FILE";
  if (static_cast<std::size_t>(status.st_size) > kLargestFile) return "larger than 1 MiB";
  return {};
}

std::string read_all(int descriptor, std::string& problem) {
  std::string text(kLargestFile, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = read(descriptor, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) problem = std::strerror(errno);
    if (got <= 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(problem.empty() ? size : 0);
  return text;
}

}  // namespace

std::string read_security_file(const std::filesystem::path& file, bool is_secret, std::string& problem) {
  problem.clear();
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    problem = std::strerror(errno);
    return {};
  }
  problem = refusal_of_file(descriptor, is_secret);
  std::string text = problem.empty() ? read_all(descriptor, problem) : std::string();
  close(descriptor);
  return text;
}

Certificate::Certificate(const std::string& pem)
    : certificate_(PEM_read_bio_X509(reading(pem).get(), nullptr, nullptr, nullptr), [](X509* x) { X509_free(x); }) {
  ERR_clear_error();
}

std::string Certificate::problem_of_validity(std::int64_t now_s) const {
  auto now = static_cast<std::time_t>(now_s);
  const ASN1_TIME* const begin = X509_get0_notBefore(get());
  const ASN1_TIME* const end = X509_get0_notAfter(get());
  // 0 is an error of the time's format.
  if (X509_cmp_time(begin, &now) >= 0) return "is not valid before " + date_text(begin) + "; is the clock right?";
  if (X509_cmp_time(end, &now) <= 0) return "has expired on " + date_text(end);
  return {};
}

std::int64_t Certificate::not_after_s() const {
  std::tm time{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(get()), &time) != 1) return 0;
  return timegm(&time);
}

std::string Certificate::problem_of_issuer(const Certificate& authority, std::int64_t now_s) const {
  const Store store = trusting(authority, now_s);
  const StoreContext context(X509_STORE_CTX_new());
  if (X509_STORE_CTX_init(context.get(), store.get(), get(), nullptr) != 1) return latest_reason();
  const bool is_issued = X509_verify_cert(context.get()) == 1;
  ERR_clear_error();
  if (is_issued) return {};
  return "is not issued by " + authority.subject() + ": " +
         X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get()));
}

std::string Certificate::problem_of_key(const std::string& pem) const {
  // Without this function OpenSSL would ask for a password at the terminal.
  const auto no_password = [](char*, int, int, void*) { return -1; };
  const Key key(PEM_read_bio_PrivateKey(reading(pem).get(), nullptr, no_password, nullptr));
  const bool is_key = key != nullptr;
  const bool belongs = is_key && X509_check_private_key(get(), key.get()) == 1;
  ERR_clear_error();
  if (!is_key) return "holds no private key in PEM format, or one with a password";
  return belongs ? "" : "does not belong to the certificate";
}

std::string Certificate::subject() const {
  const Bio out(BIO_new(BIO_s_mem()));
  X509_NAME_print_ex(out.get(), X509_get_subject_name(get()), 0, XN_FLAG_RFC2253 & ~ASN1_STRFLGS_ESC_MSB);
  return text_in(out.get());
}

std::string content_signed_by(const Certificate& authority, const std::string& document, std::int64_t now_s,
                              std::string& problem) {
  problem.clear();
  BIO* detached = nullptr;
  const Signed signature(SMIME_read_PKCS7(reading(document).get(), &detached));
  const Bio owner(detached);
  if (!signature) {
    ERR_clear_error();
    problem = "is not signed: no S/MIME document";
    return {};
  }
  const Store store = trusting(authority, now_s);
  const Bio content(BIO_new(BIO_s_mem()));
  if (PKCS7_verify(signature.get(), nullptr, store.get(), detached, content.get(), PKCS7_TEXT) != 1) {
    problem = "is not signed by " + authority.subject() + ": " + latest_reason();
    return {};
  }
  STACK_OF(X509)* const signers = PKCS7_get0_signers(signature.get(), nullptr, 0);
  const bool is_by_itself = sk_X509_num(signers) == 1 && X509_cmp(sk_X509_value(signers, 0), authority.get()) == 0;
  sk_X509_free(signers);
  if (!is_by_itself) {
    problem = "is signed by another certificate than " + authority.subject();
    return {};
  }
  return text_in(content.get());
}

}  // namespace boresight::dds
