// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/assembly/link_section.hh"

#include <sys/stat.h>
#include <unistd.h>

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::publish {
namespace {

constexpr int PORT = 1883, TLS_PORT = 8883;

std::optional<BrokerAddress> address(const ini::IniEntry &entry, bool isTls, diagnostics::Sink &sink) {
    BrokerAddress address{entry.value, isTls ? TLS_PORT : PORT};
    const std::size_t colon = entry.value.rfind(':');
    const bool isBracketed = entry.value.starts_with('[');
    const std::size_t end = isBracketed ? entry.value.find(']') : std::string::npos;
    const bool hasPort =
        colon != std::string::npos && (!isBracketed || (end != std::string::npos && colon > end));
    if (hasPort) {
        const auto port = parse_uint(std::string_view(entry.value).substr(colon + 1));
        constexpr std::uint64_t LAST = 65535;
        if (!port.has_value() || *port == 0 || *port > LAST) {
            sink.error(fmt::format("'{}' is not HOST:PORT.", entry.value), entry.place);
            return std::nullopt;
        }
        address.port = static_cast<int>(*port);
        address.host = entry.value.substr(0, colon);
    }
    if (isBracketed && address.host.size() > 2) {
        address.host = address.host.substr(1, address.host.size() - 2);
    }
    if (address.host.empty() || address.host.find_first_of(" /") != std::string::npos) {
        sink.error(fmt::format("'{}' is not HOST:PORT.", entry.value), entry.place);
        return std::nullopt;
    }
    return address;
}

SourcePlace place(const SectionSource &source, const ini::IniKey &key) {
    const ini::IniEntry *const entry = source.reader.find(key);
    return entry == nullptr ? source.file.place_of_section(std::string(key.section)) : entry->place;
}

std::string file_of(const SectionSource &source, const ini::IniKey &key) {
    const std::string name = source.reader.text(key);
    if (name.empty()) {
        return "";
    }
    std::string path = source.file.resolve_path(name);
    if (::access(path.c_str(), R_OK) != 0) {
        source.sink.error(fmt::format("[{}]{}: cannot read {}.", key.section, key.name, path),
                          place(source, key));
    }
    return path;
}

}  // namespace

std::string read_password(const SectionSource &source, const ini::IniKey &key) {
    const std::string path = file_of(source, key);
    struct stat facts{};
    if (path.empty() || ::stat(path.c_str(), &facts) != 0) {
        return "";
    }
    if ((facts.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
        source.sink.error(fmt::format("Other users can read the password in {}.", path), place(source, key),
                          "chmod 600");
    }
    constexpr std::size_t MOST = 4096;
    const auto text = read_file(path, MOST);
    return text.has_value() ? std::string(trim(*text)) : "";
}

LinkSettings read_link_section(const SectionSource &source, const LinkKeys &keys) {
    ini::IniReader &reader = source.reader;
    const std::string_view section = keys.broker.section;
    const bool isTls = reader.boolean(keys.tls);
    LinkSettings link;
    for (const ini::IniEntry *entry : reader.list(keys.broker)) {
        if (auto found = address(*entry, isTls, source.sink); found.has_value()) {
            link.brokers.push_back(std::move(*found));
        }
    }
    link.isTls = isTls;
    link.keepalive_s = static_cast<int>(reader.integer(keys.keepalive));
    link.user = reader.text(keys.user);
    link.password = read_password(source, keys.password_file);
    link.authorities = file_of(source, keys.ca_file);
    link.certificate = file_of(source, keys.certificate);
    link.key = file_of(source, keys.key);
    if (link.certificate.empty() != link.key.empty()) {
        source.sink.error(fmt::format("CERTIFICATE and KEY of [{}] must both be set.", section),
                          place(source, link.key.empty() ? keys.certificate : keys.key));
    }
    const bool hasCertificates = !link.authorities.empty() || !link.certificate.empty();
    if (hasCertificates && !isTls) {
        source.sink.error(fmt::format("Certificates have no effect without TLS = yes in [{}].", section),
                          place(source, link.authorities.empty() ? keys.certificate : keys.ca_file));
    }
    if (!link.password.empty() && link.user.empty()) {
        source.sink.error(fmt::format("PASSWORD_FILE of [{}] needs USER.", section),
                          place(source, keys.password_file));
    }
    return link;
}

}  // namespace mw::publish
