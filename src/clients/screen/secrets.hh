// SPDX-License-Identifier: GPL-2.0-or-later
// Tokens, and the certificate of a server that other computers reach. The only files that know OpenSSL,
// beside server.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::screen {

/// 256 bits of the system's, in hexadecimal.
Result<std::string> random_secret();
/// Takes the same time wherever they differ.
bool areSame(std::string_view a, std::string_view b);

/// Nothing where there is no such file; an error when another user could read it.
Result<std::optional<std::string>> read_secret_file(const std::string &path);
/// For this user alone, in a folder that is created when missing. Synced: after a crash it is the old file
/// or the new one.
Result<> write_secret_file(const std::string &path, std::string_view text);

struct Certificate {
    std::string certificate_pem, key_pem;
    std::string fingerprint;  ///< SHA-256 as browsers show it, "AB:CD:..."
};

/// Reads certificate.pem and key.pem of a folder; makes them, signed by itself for ten years, where neither
/// is there. `names`: names and addresses of this computer, for a certificate that is made.
Result<Certificate> read_or_make_certificate(const std::string &folder,
                                             const std::vector<std::string> &names);

}  // namespace mw::screen
