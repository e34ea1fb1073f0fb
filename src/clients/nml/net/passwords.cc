// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/passwords.hh"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::nml {
namespace {

/// Compares every byte, also after the first difference.
bool isSame(std::string_view given, std::string_view right) {
    unsigned difference = given.size() == right.size() ? 0 : 1;
    for (std::size_t i = 0; i < given.size(); ++i) {
        difference |=
            static_cast<unsigned>(given[i] ^ (right.empty() ? '\0' : right[i % right.size()])) & 0xffU;
    }
    return difference == 0;
}

}  // namespace

Result<Passwords> Passwords::load(const std::string &path) {
    struct stat status{};
    if (::stat(path.c_str(), &status) != 0) {
        return fail(fmt::format("password file: {}", std::strerror(errno)), {path, 0, 0});
    }
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
        return fail("others than its owner may read the password file", {path, 0, 0}, "chmod 600");
    }
    const auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    Passwords passwords;
    std::string_view left = *text;
    for (int number = 1; !left.empty(); ++number) {
        const std::size_t end = std::min(left.find('\n'), left.size());
        const std::string_view line = trim(left.substr(0, end));
        left.remove_prefix(std::min(end + 1, left.size()));
        if (line.empty() || line.front() == '#') {
            continue;
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || colon == 0 || colon + 1 == line.size()) {
            return fail("a line of a password file is name:password", {path, number, 1});
        }
        passwords.users_.push_back({std::string(line.substr(0, colon)), std::string(line.substr(colon + 1))});
    }
    if (passwords.users_.empty()) {
        return fail("the password file has no name", {path, 0, 0});
    }
    return passwords;
}

bool Passwords::isRight(std::string_view name, std::string_view password) const {
    bool isRight = false;
    for (const Credentials &user : users_) {
        const bool is_name = isSame(name, user.name), is_password = isSame(password, user.password);
        isRight = isRight || (is_name && is_password);
    }
    return isRight;
}

}  // namespace mw::nml
