#include "services/health/dds/security.hpp"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boresight::dds {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 7;
constexpr std::int64_t kDay_s = 86'400;

std::int64_t now_s() {
  return std::time(nullptr);
}

int exit_code_of(const std::string& command) {
  const int status = std::system((command + " > /dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const fs::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

/// Credentials by deploy/dds_security: valid for 365 days, in domain 7 only.
class DdsSecurityFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (exit_code_of("openssl version") != 0) GTEST_SKIP() << "skipped: openssl is not installed";
    root_ = fs::temp_directory_path() / ("boresight_security_" + std::to_string(getpid()));
    fs::remove_all(root_);
    ASSERT_EQ(make(""), 0);
    folder_ = root_ / "health";
  }
  void TearDown() override { fs::remove_all(root_); }

  [[nodiscard]] int make(const std::string& options) const {
    return exit_code_of(BORESIGHT_SOURCE_DIR "/deploy/dds_security " + root_.string() + " --domain 7 " + options);
  }
  [[nodiscard]] std::string problem(std::int64_t at_s = now_s(), std::uint32_t domain = kDomain) const {
    return check_security(secured_by(folder_), domain, at_s).problem;
  }
  void copy(const std::string& from, const std::string& to) const {
    fs::copy_file(root_ / from, folder_ / to, fs::copy_options::overwrite_existing);
  }
  /// Signs a changed document in place of the original.
  void change(const std::string& document, const std::string& sed) const {
    const std::string file = (folder_ / (document + ".p7s")).string();
    const std::string authority = (root_ / "authority" / "permissions_ca").string();
    ASSERT_EQ(exit_code_of("openssl smime -verify -text -in " + file + " -CAfile " + authority + ".pem -out " + file +
                           ".xml && sed -i '" + sed + "' " + file + ".xml && openssl smime -sign -text -in " + file +
                           ".xml -out " + file + " -signer " + authority + ".pem -inkey " + authority + ".key"),
              0);
  }

  fs::path root_, folder_;
};

TEST_F(DdsSecurityFiles, OfTheScriptAreAcceptedUntilTheyExpire) {
  const SecurityState state = check_security(secured_by(folder_), kDomain, now_s());
  EXPECT_EQ(state.problem, "");
  EXPECT_NEAR(static_cast<double>(state.valid_until_s - now_s()), 365.0 * kDay_s, kDay_s);
  EXPECT_EQ(problem(now_s() + 364 * kDay_s - kDay_s), "");
  EXPECT_THAT(problem(now_s() + 366 * kDay_s), HasSubstr("certificate.pem: has expired on "));
  EXPECT_THAT(problem(now_s() - kDay_s), HasSubstr("is the clock right?"));
  EXPECT_EQ(check_security({}, kDomain, 0).problem, "") << "security is off";
}

TEST_F(DdsSecurityFiles, EachThatIsMissingIsNamedWithItsKey) {
  for (const auto& [key, file] :
       {std::pair{"identity_ca", "identity_ca.pem"}, std::pair{"certificate", "certificate.pem"},
        std::pair{"private_key", "private_key.pem"}, std::pair{"permissions_ca", "permissions_ca.pem"},
        std::pair{"governance", "governance.p7s"}, std::pair{"permissions", "permissions.p7s"}}) {
    fs::rename(folder_ / file, root_ / "aside");
    EXPECT_EQ(problem(),
              "dds.security." + std::string(key) + ": " + (folder_ / file).string() + ": No such file or directory");
    std::ofstream(folder_ / file) << "nonsense";
    EXPECT_THAT(problem(), HasSubstr("dds.security." + std::string(key) + ": ")) << "nonsense";
    fs::remove(folder_ / file);
    ASSERT_EQ(mkfifo((folder_ / file).c_str(), 0600), 0);
    EXPECT_THAT(problem(), EndsWith("no regular file"));
    fs::remove(folder_ / file);
    fs::rename(root_ / "aside", folder_ / file);
  }
  EXPECT_EQ(problem(), "");
}

TEST_F(DdsSecurityFiles, APrivateKeyOfAnotherOrOpenToOthersIsRefused) {
  ASSERT_EQ(chmod((folder_ / "private_key.pem").c_str(), 0604), 0);
  EXPECT_THAT(problem(), EndsWith("private_key.pem: others have access to it; chmod o= FILE"));
  ASSERT_EQ(chmod((folder_ / "private_key.pem").c_str(), 0600), 0);
  copy("diagnosis/private_key.pem", "private_key.pem");
  EXPECT_THAT(problem(), EndsWith("private_key.pem: does not belong to the certificate"));
}

TEST_F(DdsSecurityFiles, ACertificateOfAnotherAuthorityIsRefused) {
  copy("health/permissions_ca.pem", "identity_ca.pem");
  EXPECT_THAT(problem(), HasSubstr("certificate.pem: is not issued by CN=permissions authority"));
}

TEST_F(DdsSecurityFiles, OneAuthorityForIdentityAndPermissionsIsRefused) {
  copy("health/identity_ca.pem", "permissions_ca.pem");
  EXPECT_THAT(problem(), HasSubstr("could sign permissions for itself"));
}

TEST_F(DdsSecurityFiles, DocumentsThatWereChangedOrSignedByAParticipantAreRefused) {
  const std::string governance = text_of(folder_ / "governance.p7s");
  std::string changed = governance;
  changed.replace(changed.find("ENCRYPT_WITH"), 7, "SIGN   ");
  std::ofstream(folder_ / "governance.p7s") << changed;
  EXPECT_THAT(problem(), HasSubstr("governance.p7s: is not signed by CN=permissions authority"));
  std::ofstream(folder_ / "governance.p7s") << governance;
  const std::string file = (folder_ / "permissions.p7s").string();
  ASSERT_EQ(exit_code_of("openssl smime -verify -noverify -text -in " + file + " -out " + file +
                         ".xml && openssl smime "
                         "-sign -text -in " +
                         file + ".xml -out " + file + " -signer " + folder_.string() + "/certificate.pem -inkey " +
                         folder_.string() + "/private_key.pem"),
            0);
  EXPECT_THAT(problem(), HasSubstr("permissions.p7s: is not signed by CN=permissions authority"));
}

TEST_F(DdsSecurityFiles, PermissionsOfAnotherParticipantDomainOrTimeAreRefused) {
  EXPECT_THAT(problem(now_s(), 8), HasSubstr("governance.p7s: has no rule for DDS domain 8"));
  change("governance", "s,<id>7</id>,<id_range><min>0</min><max>232</max></id_range>,");
  EXPECT_THAT(problem(now_s(), 8), EndsWith("grants CN=health,OU=vehicle,O=Boresight nothing in DDS domain 8"));
  EXPECT_EQ(problem(), "");
  change("permissions", "s,<not_after>20..,<not_after>2020,");
  EXPECT_THAT(problem(), HasSubstr("permissions.p7s: has expired on 2020-"));
  copy("diagnosis/permissions.p7s", "permissions.p7s");
  EXPECT_THAT(problem(), EndsWith("grants nothing to CN=health,OU=vehicle,O=Boresight"));
}

TEST_F(DdsSecurityFiles, AGovernanceThatLeavesTheDomainOpenIsRefused) {
  const std::string original = text_of(folder_ / "governance.p7s");
  for (const auto& [sed, reason] :
       {std::pair{"s,participants>false,participants>true,", "allow_unauthenticated_participants must be false"},
        std::pair{"s,join_access_control>true,join_access_control>false,", "enable_join_access_control must be true"},
        std::pair{"s,discovery_protection_kind>E.*<,discovery_protection_kind>NONE<,",
                  "discovery_protection_kind must"},
        std::pair{"s,write_access_control>true,write_access_control>false,",
                  "enable_write_access_control of topic_rule *"},
        std::pair{"s,read_access_control>true,read_access_control>false,",
                  "enable_read_access_control of topic_rule *"},
        std::pair{"s,metadata_protection_kind>E.*<,metadata_protection_kind>NONE<,", "must not be NONE"}}) {
    change("governance", sed);
    EXPECT_THAT(problem(), HasSubstr(reason)) << sed;
    std::ofstream(folder_ / "governance.p7s") << original;
  }
  EXPECT_EQ(problem(), "");
}

TEST_F(DdsSecurityFiles, AParticipantIsSecuredOrNotMade) {
  eprosima::fastdds::dds::DomainParticipantQos qos;
  const std::size_t before = qos.properties().properties().size();
  secure(qos, {}, kDomain);
  EXPECT_EQ(qos.properties().properties().size(), before) << "security is off";
  secure(qos, secured_by(folder_), kDomain);
  EXPECT_EQ(qos.properties().properties().size(), before + 9);
  fs::remove(folder_ / "governance.p7s");
  EXPECT_THROW(secure(qos, secured_by(folder_), kDomain), std::runtime_error);
}

TEST_F(DdsSecurityFiles, TheScriptKeepsWhatIsThereAndRenewsCertificatesOnly) {
  const std::string key = text_of(folder_ / "private_key.pem"), certificate = text_of(folder_ / "certificate.pem");
  EXPECT_EQ(make(""), 0);
  EXPECT_EQ(text_of(folder_ / "certificate.pem"), certificate) << "a second run";
  EXPECT_EQ(make("--renew"), 0);
  EXPECT_EQ(text_of(folder_ / "private_key.pem"), key) << "--renew";
  EXPECT_NE(text_of(folder_ / "certificate.pem"), certificate) << "--renew";
  fs::remove(folder_ / "private_key.pem");
  EXPECT_EQ(make(""), 1) << "a key is not replaced by accident";
  EXPECT_EQ(make("--force"), 0);
  EXPECT_NE(text_of(folder_ / "private_key.pem"), key) << "--force";
  EXPECT_EQ(problem(), "");
  EXPECT_EQ(make("--domain 233"), 2);
  EXPECT_EQ(make("--days 0 --renew"), 1) << "certificates that have expired at once";
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(root_)) {
    struct stat status {};
    ASSERT_EQ(stat(file.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, file.is_directory() ? 0700U : 0600U) << file.path();
  }
}

}  // namespace
}  // namespace boresight::dds
