// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of section [SHOP].
#pragma once

#include <array>

#include "base/ini/ini_key.hh"

namespace mw::shop {

// clang-format off
inline constexpr auto SHOP_KEYS = std::to_array<ini::IniKey>({
    ini::ini_text("SHOP", "NAME", "Sparkplug host application: [PUBLISH]PRIMARY_HOST of the machines", "shop"),
    ini::ini_list("SHOP", "BROKER", "HOST or HOST:PORT of an MQTT broker; several are tried one after another"),
    ini::ini_list("SHOP", "GROUP", "Sparkplug group that is collected; without it all. Collectors share the load by groups"),
    ini::ini_flag("SHOP", "TLS", false, "encrypts the connection to the broker and checks its certificate"),
    ini::ini_text("SHOP", "CA_FILE", "certificate authorities (PEM) of the broker; without it those of this computer"),
    ini::ini_text("SHOP", "CERTIFICATE", "client certificate (PEM) for the broker"),
    ini::ini_text("SHOP", "KEY", "private key (PEM) of that certificate"),
    ini::ini_text("SHOP", "USER", "user at the broker"),
    ini::ini_text("SHOP", "PASSWORD_FILE", "file with the password of USER, readable by this user only"),
    ini::ini_whole("SHOP", "KEEPALIVE", "s", 10, {5, 3600}, "interval of signs of life to the broker"),
    ini::ini_text("SHOP", "DATABASE", "connection to PostgreSQL, as libpq takes it", "dbname=millwright"),
    ini::ini_whole("SHOP", "KEEP_DAYS", "", 0, {0, 36500}, "days of values that are kept; 0: all"),
    ini::ini_whole("SHOP", "PORT", "", -1, {-1, 65535}, "TCP port of the shop page; 0: a free one; without it there is no page"),
    ini::ini_text("SHOP", "LISTEN", "address at which other computers reach the page, 0.0.0.0: all; without it only this computer"),
    ini::ini_list("SHOP", "LISTEN_NAME", "name by which other computers call this one, beside its own"),
    ini::ini_text("SHOP", "SECRETS", "folder of tokens and certificate: with it the page for other computers needs TLS and a token"),
    ini::ini_text("SHOP", "MAIL_SERVER", "smtp://HOST:PORT or smtps://HOST:PORT of the mail server"),
    ini::ini_text("SHOP", "MAIL_FROM", "sender of mails"),
    ini::ini_list("SHOP", "MAIL_TO", "receiver of a mail for each alarm and each machine that stops"),
    ini::ini_text("SHOP", "MAIL_USER", "user at the mail server"),
    ini::ini_text("SHOP", "MAIL_PASSWORD_FILE", "file with the password of MAIL_USER, readable by this user only"),
    ini::ini_list("SHOP", "WEBHOOK", "http(s) address that receives each notification as JSON"),
});
// clang-format on

}  // namespace mw::shop
