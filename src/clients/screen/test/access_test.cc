// SPDX-License-Identifier: GPL-2.0-or-later
// Tests tokens, roles and their files (J3).
#include <openssl/bn.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/access/access.hh"
#include "clients/screen/access/secrets.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

constexpr int PORT = 8851;

class AccessTest : public testing::Test {
  protected:
    AccessTest() {
        const auto *info = testing::UnitTest::GetInstance()->current_test_info();
        folder = fs::temp_directory_path() /
                 (std::string("mw_access_") + info->name() + std::to_string(::getpid())) / "below";
        tokens = (folder / "tokens").string();
    }
    ~AccessTest() override { fs::remove_all(folder.parent_path()); }

    fs::path folder;
    std::string tokens;
};

std::string secret_of(const Tokens &all, Role role) {
    for (const Tokens::Token &one : all.all()) {
        if (one.role == role) {
            return one.secret;
        }
    }
    return "";
}

Request post(const std::string &body) {
    Request request;
    request.method = "POST";
    request.body = body;
    return request;
}

TEST_F(AccessTest, TheFirstStartMakesATokenForEachRoleThatOnlyItsUserReads) {
    const auto made = Tokens::read_or_make(tokens);
    ASSERT_TRUE(made.has_value()) << made.error().str();
    struct stat facts{};
    ASSERT_EQ(::stat(tokens.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777U, 0600U);
    for (const Role role : {Role::VIEW, Role::OPERATE, Role::CONFIGURE}) {
        const std::string secret = secret_of(*made, role);
        EXPECT_EQ(secret.size(), 64U);
        EXPECT_EQ(made->role_of(secret), role);
        EXPECT_EQ(made->role_of(secret.substr(1)), Role::NOBODY);
        EXPECT_EQ(made->role_of(secret + "0"), Role::NOBODY);
    }
    EXPECT_EQ(made->role_of(""), Role::NOBODY);
    const auto again = Tokens::read_or_make(tokens);
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(secret_of(*again, Role::OPERATE), secret_of(*made, Role::OPERATE));
}

TEST_F(AccessTest, AFileThatOthersReadOrThatIsNoneIsRefused) {
    fs::create_directories(folder);
    std::ofstream(tokens) << "view " << std::string(64, 'a') << "\n";
    ::chmod(tokens.c_str(), 0640);
    const auto open = Tokens::read_or_make(tokens);
    ASSERT_FALSE(open.has_value());
    EXPECT_NE(open.error().str().find("chmod 600"), std::string::npos);
    ::chmod(tokens.c_str(), 0600);
    EXPECT_TRUE(Tokens::read_or_make(tokens).has_value());
    for (const std::string &bad :
         {"boss " + std::string(64, 'a'), std::string("view short"), std::string("view")}) {
        std::ofstream(tokens) << "# remark\n" << bad << "\n";
        const auto read = Tokens::read_or_make(tokens);
        ASSERT_FALSE(read.has_value()) << bad;
        EXPECT_NE(read.error().str().find(":2:"), std::string::npos) << read.error().str();
    }
}

TEST_F(AccessTest, ATokenOpensWhatItsRoleMay) {
    const auto made = Tokens::read_or_make(tokens);
    ASSERT_TRUE(made.has_value());
    const Access access(*made);
    const std::string secret = secret_of(*made, Role::VIEW);
    EXPECT_EQ(access.role_of({"", ""}, PORT), Role::NOBODY);
    EXPECT_EQ(access.role_of({"Bearer " + secret, ""}, PORT), Role::VIEW);
    EXPECT_EQ(access.role_of({"Bearer wrong", ""}, PORT), Role::NOBODY);
    EXPECT_EQ(access.role_of({"Basic " + secret, ""}, PORT), Role::NOBODY);
    EXPECT_EQ(access.role_of({"", "a=b; millwright_token_8851=" + secret}, PORT), Role::VIEW);
    EXPECT_EQ(access.role_of({"", "millwright_token_8852=" + secret}, PORT), Role::NOBODY);
    EXPECT_EQ(access.role_of({"", "x_millwright_token_8851=" + secret}, PORT), Role::NOBODY);
    EXPECT_EQ(access.role_of({"Bearer wrong", "millwright_token_8851=" + secret}, PORT), Role::NOBODY);
}

TEST_F(AccessTest, LoginGivesACookieThatNoScriptReads) {
    const auto made = Tokens::read_or_make(tokens);
    ASSERT_TRUE(made.has_value());
    Access access(*made);
    const std::string secret = secret_of(*made, Role::OPERATE);
    const Response in = access.login(post(R"({"token":")" + secret + R"("})"), PORT, 0);
    EXPECT_EQ(in.status, 200);
    EXPECT_EQ(in.body, R"({"role":"operate","protection":"tls"})");
    EXPECT_TRUE(in.cookie.starts_with("millwright_token_8851=" + secret + ";")) << in.cookie;
    for (const char *rule : {"; Secure", "; HttpOnly", "; SameSite=Strict", "; Path=/"}) {
        EXPECT_NE(in.cookie.find(rule), std::string::npos) << rule;
    }
    Request out;
    out.method = "DELETE";
    EXPECT_NE(access.login(out, PORT, 0).cookie.find("Max-Age=0"), std::string::npos);
    for (const std::string body : {"", "[]", "{}", R"({"token":1})", R"("x")"}) {
        EXPECT_EQ(access.login(post(body), PORT, 0).status, 400) << body;
    }
}

TEST_F(AccessTest, OnThisComputerTheUserOfTheServerNeedsNoTokenAndOthersDo) {
    const Tokens file({{Role::OPERATE, std::string(64, 'o')}}),
        cookies({{Role::OPERATE, std::string(64, 'c')}});
    Access access = Access::of_this_computer(file, cookies);
    const std::string bearer = "Bearer " + std::string(64, 'o');
    EXPECT_EQ(access.protection(), Protection::LOCAL);
    EXPECT_EQ(access.role_of({"", "", true}, PORT), Role::CONFIGURE);
    EXPECT_EQ(access.role_of({"", "", false}, PORT), Role::STATUS);
    EXPECT_EQ(access.role_of({"Bearer wrong", "", false}, PORT), Role::STATUS);
    EXPECT_EQ(access.role_of({bearer, "", false}, PORT), Role::OPERATE);
    Request asked;
    asked.method = "GET";
    asked.role = Role::STATUS;
    EXPECT_EQ(access.login(asked, PORT, 0).body, R"({"role":"","protection":"local"})");
    const Response in = access.login(post(R"({"token":")" + std::string(64, 'o') + R"("})"), PORT, 0);
    EXPECT_TRUE(in.cookie.starts_with("millwright_token_8851=" + std::string(64, 'c') + ";")) << in.cookie;
    EXPECT_EQ(in.cookie.find("Secure"), std::string::npos) << "the address is http";
    EXPECT_EQ(access.role_of({"", in.cookie.substr(0, in.cookie.find(';')), false}, PORT), Role::OPERATE);
    EXPECT_EQ(access.role_of({"", "millwright_token_8851=" + std::string(64, 'o'), false}, PORT),
              Role::STATUS)
        << "a token is no cookie";
}

TEST_F(AccessTest, WrongTokensAreCountedAndTheRightOneStillOpens) {
    const auto made = Tokens::read_or_make(tokens);
    ASSERT_TRUE(made.has_value());
    Access access(*made);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(access.login(post(R"({"token":"guess"})"), PORT, 1).status, 403);
    }
    EXPECT_EQ(access.login(post(R"({"token":"guess"})"), PORT, 1).status, 429);
    EXPECT_EQ(access.login(post(R"({"token":")" + secret_of(*made, Role::VIEW) + R"("})"), PORT, 1).status,
              200);
    EXPECT_EQ(access.login(post(R"({"token":"guess"})"), PORT, 10000000000).status, 403);
}

TEST_F(AccessTest, ACertificateIsMadeOnceAndReadAgain) {
    const auto made = read_or_make_certificate(folder.string(), {"mill", "192.168.1.5", "fe80::1"});
    ASSERT_TRUE(made.has_value()) << made.error().str();
    EXPECT_EQ(made->fingerprint.size(), 95U);
    struct stat facts{};
    ASSERT_EQ(::stat((folder / "key.pem").c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777U, 0600U);
    const auto again = read_or_make_certificate(folder.string(), {"other"});
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->fingerprint, made->fingerprint);
    EXPECT_EQ(again->key_pem, made->key_pem);
    fs::remove(folder / "key.pem");
    const auto half = read_or_make_certificate(folder.string(), {});
    ASSERT_FALSE(half.has_value());
    EXPECT_NE(half.error().str().find("without its key"), std::string::npos);
}

// A number that begins with a zero byte is not valid in DER: OpenSSL cannot read such a certificate.
TEST_F(AccessTest, ACertificateCanBeReadAgainWhateverItsNumber) {
    constexpr unsigned LONGEST_BITS = 127, WAYS = 20;
    for (unsigned i = 0; i < WAYS; ++i) {
        const auto made = read_or_make_certificate(folder.string(), {"mill"});
        ASSERT_TRUE(made.has_value()) << made.error().str();
        const std::string &text = made->certificate_pem;
        const std::unique_ptr<BIO, decltype(&BIO_free)> bio(
            BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), &BIO_free);
        const std::unique_ptr<X509, decltype(&X509_free)> read(
            PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr), &X509_free);
        ASSERT_NE(read, nullptr);
        const std::unique_ptr<BIGNUM, decltype(&BN_free)> number(
            ASN1_INTEGER_to_BN(X509_get0_serialNumber(read.get()), nullptr), &BN_free);
        EXPECT_EQ(static_cast<unsigned>(BN_num_bits(number.get())), LONGEST_BITS);
        EXPECT_EQ(BN_is_negative(number.get()), 0);
        fs::remove_all(folder);
    }
}

TEST_F(AccessTest, WhatIsNoCertificateIsToldWithWhatToDo) {
    ASSERT_TRUE(read_or_make_certificate(folder.string(), {"mill"}).has_value());
    std::ofstream(folder / "certificate.pem") << "nothing of the kind\n";
    const auto again = read_or_make_certificate(folder.string(), {});
    ASSERT_FALSE(again.has_value());
    EXPECT_NE(again.error().str().find("no certificate in PEM"), std::string::npos);
    EXPECT_NE(again.error().str().find("new ones are made"), std::string::npos) << again.error().str();
}

}  // namespace
}  // namespace mw::screen
