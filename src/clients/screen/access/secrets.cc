// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/access/secrets.hh"

#include <arpa/inet.h>
#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

template <auto Free>
struct Freed {
    template <class Thing>
    void operator()(Thing *thing) const {
        Free(thing);
    }
};
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using X509Ptr = std::unique_ptr<X509, Freed<X509_free>>;
using Bio = std::unique_ptr<BIO, Freed<BIO_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>>;

std::string text_of(BIO *bio) {
    char *data = nullptr;
    const long size = BIO_get_mem_data(bio, &data);
    return size > 0 ? std::string(data, static_cast<std::size_t>(size)) : std::string();
}

bool isAddress(const std::string &name) {
    std::array<unsigned char, sizeof(in6_addr)> ignored{};
    return ::inet_pton(AF_INET, name.c_str(), ignored.data()) == 1 ||
           ::inet_pton(AF_INET6, name.c_str(), ignored.data()) == 1;
}

bool add_extension(X509 *certificate, int kind, const std::string &value) {
    X509V3_CTX context;
    X509V3_set_ctx_nodb(&context);
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    const Extension one(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
    return one != nullptr && X509_add_ext(certificate, one.get(), -1) == 1;
}

/// A certificate signed with its own key; null when OpenSSL fails.
X509Ptr sign_new(EVP_PKEY *key, const std::vector<std::string> &names) {
    constexpr int VERSION_3 = 2;
    constexpr long TEN_YEARS_S = 3650L * 24 * 3600;
    X509Ptr made(X509_new());
    std::array<unsigned char, 16> serial{};
    if (made == nullptr || RAND_bytes(serial.data(), serial.size()) != 1) {
        return nullptr;
    }
    // positive, and all bytes are significant: DER
    serial[0] = static_cast<unsigned char>((serial[0] & 0x3fU) | 0x40U);
    X509_set_version(made.get(), VERSION_3);
    ASN1_STRING_set(X509_get_serialNumber(made.get()), serial.data(), serial.size());
    X509_gmtime_adj(X509_getm_notBefore(made.get()), -24L * 3600);  // clocks differ
    X509_gmtime_adj(X509_getm_notAfter(made.get()), TEN_YEARS_S);
    X509_set_pubkey(made.get(), key);
    X509_NAME *subject = X509_get_subject_name(made.get());
    const std::string common = "Millwright screen";
    X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8,
                               reinterpret_cast<const unsigned char *>(common.c_str()), -1, -1, 0);
    X509_set_issuer_name(made.get(), subject);
    std::string alternatives;
    for (const std::string &name : names) {
        alternatives +=
            (alternatives.empty() ? "" : ",") + std::string(isAddress(name) ? "IP:" : "DNS:") + name;
    }
    const bool whole = add_extension(made.get(), NID_basic_constraints, "critical,CA:FALSE") &&
                       add_extension(made.get(), NID_ext_key_usage, "serverAuth") &&
                       add_extension(made.get(), NID_subject_alt_name, alternatives) &&
                       X509_sign(made.get(), key, EVP_sha256()) > 0;
    return whole ? std::move(made) : nullptr;
}

Result<std::string> fingerprint_of(const X509 *certificate) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) {
        return fail("OpenSSL cannot compute the fingerprint of the certificate");
    }
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest[i]);
    }
    return text;
}

Result<Certificate> make(const std::string &certificate_path, const std::string &key_path,
                         const std::vector<std::string> &names) {
    const Key key(EVP_EC_gen("P-256"));
    const X509Ptr made = key == nullptr ? nullptr : sign_new(key.get(), names);
    const Bio key_text(BIO_new(BIO_s_mem())), certificate_text(BIO_new(BIO_s_mem()));
    const bool is_written =
        made != nullptr && PEM_write_bio_X509(certificate_text.get(), made.get()) == 1 &&
        PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1;
    if (!is_written) {
        return fail("OpenSSL cannot make a certificate");
    }
    Certificate certificate{text_of(certificate_text.get()), text_of(key_text.get()), ""};
    for (const auto &written : {write_secret_file(key_path, certificate.key_pem),
                                write_secret_file(certificate_path, certificate.certificate_pem)}) {
        if (!written.has_value()) {
            return std::unexpected(written.error());
        }
    }
    auto fingerprint = fingerprint_of(made.get());
    if (!fingerprint.has_value()) {
        return std::unexpected(fingerprint.error());
    }
    certificate.fingerprint = std::move(*fingerprint);
    return certificate;
}

}  // namespace

Result<std::string> random_secret() {
    std::array<unsigned char, 32> bytes{};
    if (RAND_bytes(bytes.data(), bytes.size()) != 1) {
        return fail("the system has no random numbers for a token");
    }
    std::string text;
    for (const unsigned char byte : bytes) {
        text += fmt::format("{:02x}", byte);
    }
    return text;
}

bool areSame(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Result<std::optional<std::string>> read_secret_file(const std::string &path) {
    struct stat facts{};
    if (::stat(path.c_str(), &facts) != 0) {
        return errno == ENOENT ? Result<std::optional<std::string>>(std::nullopt)
                               : fail(path + ": " + std::strerror(errno));
    }
    constexpr mode_t OTHERS = 077;
    if ((facts.st_mode & OTHERS) != 0 || facts.st_uid != ::geteuid()) {
        return fail("other users of this computer can read it, or it belongs to one", {path, 0, 0},
                    "chmod 600 " + path);
    }
    auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    return text->empty() ? std::nullopt : std::optional(std::move(*text));  // it was truncated during writing
}

Result<> write_secret_file(const std::string &path, std::string_view text) {
    std::error_code error;
    const fs::path folder = fs::path(path).parent_path();
    fs::create_directories(folder, error);
    if (error) {
        return fail("cannot make the folder " + folder.string() + ": " + error.message());
    }
    // The file gets its permissions before its content; replacing keeps them.
    const int fd = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
    if (fd < 0 && errno != EEXIST) {
        return fail("cannot write " + path + ": " + std::strerror(errno));
    }
    if (fd >= 0) {
        ::close(fd);
    }
    const auto written = write_file_atomically(path, text);
    if (!written.has_value() && fd >= 0) {
        ::unlink(path.c_str());
    }
    return written;
}

Result<Certificate> read_or_make_certificate(const std::string &folder,
                                             const std::vector<std::string> &names) {
    const std::string certificate_path = folder + "/certificate.pem", key_path = folder + "/key.pem";
    const auto key = read_secret_file(key_path);
    if (!key.has_value()) {
        return std::unexpected(key.error());
    }
    std::error_code ignored;
    const bool has_certificate = fs::exists(certificate_path, ignored);
    if (!key->has_value() && !has_certificate) {
        return make(certificate_path, key_path, names);
    }
    if (!key->has_value()) {
        return fail("there is a certificate without its key " + key_path, {certificate_path, 0, 0},
                    "put the key there, or take the certificate away: a new one is made");
    }
    const auto text = read_file(certificate_path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    const Bio bio(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())));
    const X509Ptr read(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
    if (read == nullptr) {
        return fail("this is no certificate in PEM", {certificate_path, 0, 0},
                    "take it and key.pem beside it away: new ones are made");
    }
    auto fingerprint = fingerprint_of(read.get());
    if (!fingerprint.has_value()) {
        return std::unexpected(fingerprint.error());
    }
    return Certificate{*text, **key, std::move(*fingerprint)};
}

}  // namespace mw::screen
