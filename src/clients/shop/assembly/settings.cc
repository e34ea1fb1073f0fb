// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/assembly/settings.hh"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/ini/ini_reader.hh"
#include "base/text.hh"
#include "clients/publish/assembly/link_section.hh"
#include "clients/publish/sparkplug/edge_node.hh"
#include "clients/shop/assembly/ini_keys.hh"

namespace mw::shop {
namespace {

constexpr const char *SECTION = "SHOP";

template <std::size_t N>
struct KeyName {
    char text[N]{};
    consteval KeyName(const char (&name)[N]) { std::copy_n(name, N, text); }
};
template <KeyName NAME>
inline constexpr const ini::IniKey &KEY = ini::row_of(SHOP_KEYS, SECTION, NAME.text);

std::vector<std::string> words(ini::IniReader &reader, const ini::IniKey &key) {
    std::vector<std::string> found;
    for (const ini::IniEntry *entry : reader.list(key)) {
        found.push_back(entry->value);
    }
    return found;
}

NotifierSettings read_notifier(const publish::SectionSource &source) {
    ini::IniReader &reader = source.reader;
    NotifierSettings notify;
    notify.server = reader.text(KEY<"MAIL_SERVER">);
    notify.from = reader.text(KEY<"MAIL_FROM">);
    notify.to = words(reader, KEY<"MAIL_TO">);
    notify.user = reader.text(KEY<"MAIL_USER">);
    notify.password = publish::read_password(source, KEY<"MAIL_PASSWORD_FILE">);
    notify.webhooks = words(reader, KEY<"WEBHOOK">);
    const bool hasMail = !notify.server.empty() && !notify.from.empty();
    if (!notify.to.empty() && !hasMail) {
        source.sink.error("MAIL_TO of [SHOP] needs MAIL_SERVER and MAIL_FROM.",
                          reader.list(KEY<"MAIL_TO">).front()->place);
    }
    for (const ini::IniEntry *entry : reader.list(KEY<"WEBHOOK">)) {
        if (!entry->value.starts_with("http://") && !entry->value.starts_with("https://")) {
            source.sink.error(fmt::format("'{}' is not an http or https address.", entry->value),
                              entry->place);
        }
    }
    return notify;
}

HostSettings read_host(const publish::SectionSource &source) {
    HostSettings host;
    host.name = source.reader.text(KEY<"NAME">);
    host.groups = words(source.reader, KEY<"GROUP">);
    std::vector<std::pair<const ini::IniKey *, std::string>> parts{{&KEY<"NAME">, host.name}};
    for (const std::string &group : host.groups) {
        parts.emplace_back(&KEY<"GROUP">, group);
    }
    for (const auto &[key, text] : parts) {
        if (const std::string wrong = publish::check_topic_part(text); !wrong.empty()) {
            source.sink.error(
                fmt::format("[SHOP]{} = '{}' cannot be part of a topic: {}.", key->name, text, wrong),
                source.file.place_of_section(SECTION));
        }
    }
    return host;
}

}  // namespace

std::optional<Settings> read_settings(const ini::IniFile &file, diagnostics::Sink &sink) {
    const int before = sink.count_errors();
    if (!file.hasSection(SECTION)) {
        sink.error(fmt::format("{} has no section [SHOP].", file.path()));
        return std::nullopt;
    }
    ini::IniReader reader(file, sink);
    reader.declare(SHOP_KEYS);
    const publish::SectionSource source{file, reader, reader.sink()};
    Settings settings;
    settings.host = read_host(source);
    settings.link =
        publish::read_link_section(source, {KEY<"BROKER">, KEY<"TLS">, KEY<"CA_FILE">, KEY<"CERTIFICATE">,
                                            KEY<"KEY">, KEY<"USER">, KEY<"PASSWORD_FILE">, KEY<"KEEPALIVE">});
    settings.link.client_id = fmt::format("millwright-shop/{}", settings.host.name);
    settings.link.not_delivered_topic = "millwright/none";
    if (settings.link.brokers.empty()) {
        sink.error("[SHOP] needs BROKER.", file.place_of_section(SECTION));
    }
    settings.store = {.database = reader.text(KEY<"DATABASE">),
                      .collector = settings.host.name,
                      .keep_days = static_cast<int>(reader.integer(KEY<"KEEP_DAYS">))};
    const std::int64_t port = reader.integer(KEY<"PORT">);
    if (port >= 0) {
        const std::string secrets = reader.text(KEY<"SECRETS">);
        settings.page = {static_cast<int>(port),
                         reader.text(KEY<"LISTEN">),
                         {},
                         secrets.empty() ? "" : file.resolve_path(secrets)};
        for (const std::string &name : words(reader, KEY<"LISTEN_NAME">)) {
            settings.page->names.push_back(to_lower(name));
        }
    }
    settings.notify = read_notifier(source);
    reader.report_unknown(false);
    return sink.count_errors() == before ? std::optional(std::move(settings)) : std::nullopt;
}

}  // namespace mw::shop
