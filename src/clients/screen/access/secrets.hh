// SPDX-License-Identifier: GPL-2.0-or-later
// Tokens, and the certificate of a server for other computers. Only these files and the server use OpenSSL.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::screen {

/// 256 random bits from the system, in hexadecimal.
Result<std::string> random_secret();
/// Takes the same time for each difference.
bool areSame(std::string_view a, std::string_view b);

/// Nothing if there is no such file; an error if another user could read it.
Result<std::optional<std::string>> read_secret_file(const std::string &path);
/// Writes a file for this user only; creates the folder if it is missing. Synced: after a crash it is the old
/// file or the new file.
Result<> write_secret_file(const std::string &path, std::string_view text);

struct Certificate {
    std::string certificate_pem, key_pem;
    std::string fingerprint;  ///< SHA-256 in the form of browsers, "AB:CD:..."
};

/// Reads certificate.pem and key.pem of a folder. If neither exists, creates them, self-signed for ten years.
/// `names`: names and addresses of this computer for a new certificate.
Result<Certificate> read_or_make_certificate(const std::string &folder,
                                             const std::vector<std::string> &names);

}  // namespace mw::screen
