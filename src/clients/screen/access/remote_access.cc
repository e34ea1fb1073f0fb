// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/access/remote_access.hh"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::screen {
namespace {

constexpr int PRESET_PORT = 8851;

struct Place {
    std::string address;
    int port = PRESET_PORT;
};

Result<Place> parse_place(const std::string &text) {
    const bool bracketed = text.starts_with('[');
    const std::size_t end = bracketed ? text.find(']') : std::min(text.find(':'), text.size());
    const bool is_plain_v6 = !bracketed && std::ranges::count(text, ':') > 1;
    if (is_plain_v6) {
        return Place{text};
    }
    if (end == std::string::npos) {
        return fail("--listen: '" + text + "' has no ]");
    }
    Place place{bracketed ? text.substr(1, end - 1) : text.substr(0, end)};
    const std::string rest = text.substr(end + (bracketed ? 1 : 0));
    if (rest.empty()) {
        return place;
    }
    constexpr std::uint64_t LAST_PORT = 65535;
    const auto port = rest.starts_with(':') ? parse_uint(rest.substr(1)) : std::nullopt;
    if (!port.has_value() || *port > LAST_PORT) {
        return fail("--listen: '" + text + "' is not ADDRESS:PORT");
    }
    place.port = static_cast<int>(*port);
    return place;
}

/// Names by which other computers may address this one.
std::vector<std::string> own_names() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0 || host[0] == '\0') {
        return {};
    }
    const std::string name = to_lower(host.data());
    return name.find('.') == std::string::npos ? std::vector{name, name + ".local"} : std::vector{name};
}

/// Addresses of active interfaces.
std::vector<std::string> own_addresses() {
    ifaddrs *first = nullptr;
    if (::getifaddrs(&first) != 0) {
        return {};
    }
    const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, ::freeifaddrs);
    std::vector<std::string> found;
    for (const ifaddrs *one = first; one != nullptr; one = one->ifa_next) {
        if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_UP) == 0) {
            continue;
        }
        std::array<char, INET6_ADDRSTRLEN> text{};
        const int family = one->ifa_addr->sa_family;
        const void *address = nullptr;
        if (family == AF_INET) {
            address = &reinterpret_cast<const sockaddr_in *>(one->ifa_addr)->sin_addr;
        } else if (family == AF_INET6) {
            address = &reinterpret_cast<const sockaddr_in6 *>(one->ifa_addr)->sin6_addr;
        }
        if (address != nullptr && ::inet_ntop(family, address, text.data(), text.size()) != nullptr) {
            found.emplace_back(text.data());
        }
    }
    return found;
}

bool isEverywhere(const std::string &address) {
    return address == "0.0.0.0" || address == "::";
}

}  // namespace

Result<std::string> secrets_folder() {
    const char *const config = std::getenv("XDG_CONFIG_HOME");
    if (config != nullptr && config[0] == '/') {
        return std::string(config) + "/millwright/screen";
    }
    const char *const home = std::getenv("HOME");
    if (home == nullptr || home[0] != '/') {
        return fail("neither XDG_CONFIG_HOME nor HOME names a folder for tokens and certificate");
    }
    return std::string(home) + "/.config/millwright/screen";
}

Result<std::optional<RemoteDoor>> remote_door(const DoorWords &words, const std::string &folder) {
    if (words.listen.empty()) {
        return words.names.empty() && words.unprotected.empty()
                   ? Result<std::optional<RemoteDoor>>(std::nullopt)
                   : fail("--name and --unprotected require --listen ADDRESS");
    }
    const auto place = parse_place(words.listen);
    if (!place.has_value()) {
        return std::unexpected(place.error());
    }
    std::vector<std::string> names = own_names();
    for (const std::string &name : words.names) {
        names.push_back(to_lower(name));
    }
    if (!words.unprotected.empty()) {
        const auto role = role_of_name(words.unprotected);
        return role.has_value()
                   ? Result<std::optional<RemoteDoor>>(
                         RemoteDoor{place->address, place->port, names, Access(Protection::NONE, *role), {}})
                   : fail("--unprotected: the role of all clients is view, operate or configure");
    }
    auto tokens = Tokens::read_or_make(folder + "/tokens");
    if (!tokens.has_value()) {
        return std::unexpected(tokens.error());
    }
    std::vector<std::string> certified = names;
    const auto addresses =
        isEverywhere(place->address) ? own_addresses() : std::vector<std::string>{place->address};
    certified.insert(certified.end(), addresses.begin(), addresses.end());
    auto certificate = read_or_make_certificate(folder, certified);
    if (!certificate.has_value()) {
        return std::unexpected(certificate.error());
    }
    return RemoteDoor{place->address, place->port, names, Access(std::move(*tokens)),
                      std::move(*certificate)};
}

Tokens local_tokens(const std::string &folder, diagnostics::Sink &sink) {
    if (folder.empty()) {
        return {};
    }
    auto tokens = Tokens::read_or_make(folder + "/tokens");
    if (!tokens.has_value()) {
        sink.warning(fmt::format("Other users of this computer cannot sign in to the screen: {}",
                                 tokens.error().str()));
    }
    return tokens.value_or(Tokens());
}

void report_unknown(const std::string &why, diagnostics::Sink &sink) {
    sink.warning(fmt::format("Cannot find the user of a connection on this computer: {}. Screens without a "
                             "token can only view status.",
                             why));
}

std::string status_note(int port, const std::string &folder) {
    if (folder.empty()) {
        return "Another user of this computer started the server. This screen sees status and can stop the "
               "machine. "
               "To do more, run the browser as that user.";
    }
    return fmt::format(
        "Another user of this computer started the server. This screen sees status and can stop the "
        "machine. To do more, open http://127.0.0.1:{}/#token=TOKEN with a token of {}/tokens.",
        port, folder);
}

std::string door_text(const RemoteDoor &door, int port, const std::string &folder) {
    std::string host = door.address;
    if (isEverywhere(host)) {
        const auto addresses = own_addresses();
        const auto found = std::ranges::find_if(
            addresses, [](const std::string &one) { return one != "::1" && !one.starts_with("127."); });
        host = found == addresses.end() ? "127.0.0.1" : *found;
    }
    if (host.find(':') != std::string::npos) {
        host = '[' + host + ']';
    }
    if (!door.tls.has_value()) {
        return fmt::format("for other computers, WITHOUT PROTECTION: http://{}:{}/\n", host, port);
    }
    return fmt::format("for other computers: https://{}:{}/ with a token of {}/tokens\nself-signed "
                       "certificate, SHA-256 {}\n",
                       host, port, folder, door.tls->fingerprint);
}

}  // namespace mw::screen
