// SPDX-License-Identifier: GPL-2.0-or-later
// Tests section [SHOP] of an INI file: its settings and the reported problems.
#include <regex>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/shop/assembly/ini_keys.hh"
#include "clients/shop/assembly/settings.hh"

namespace mw::shop {
namespace {

struct Read {
    std::optional<Settings> settings;
    std::string messages;
};

Read read(const std::string &text) {
    Read found;
    diagnostics::Sink sink(
        [&found](const diagnostics::Diagnostic &one) { found.messages += one.what.str() + '\n'; });
    const auto file = ini::IniFile::parse(text, "shop.ini", sink);
    found.settings = read_settings(file, sink);
    return found;
}

TEST(ShopSettings, AreAllInTheBook) {
    const auto page = read_file(MW_SOURCE_DIR "/docs/integrator/shop.md");
    ASSERT_TRUE(page.has_value());
    const std::string of_shop = page->substr(page->find("| key of [SHOP] |"));
    for (const ini::IniKey &key : SHOP_KEYS) {
        const std::regex row("\\n\\|[^|]*\\b" + std::string(key.name) + "\\b[^|]*\\|");
        EXPECT_TRUE(std::regex_search(of_shop, row)) << key.name;
    }
}

TEST(ShopSettings, ReportWhatIsWrongWithItsPlace) {
    const std::pair<const char *, const char *> CASES[] = {
        {"", "[SHOP] needs BROKER."},
        {"BROKER = a\nNAME = a/b\n", "[SHOP]NAME = 'a/b' cannot be part of a topic"},
        {"BROKER = a\nGROUP = +\n", "[SHOP]GROUP = '+' cannot be part of a topic"},
        {"BROKER = a\nMAIL_TO = a@example.org\n",
         "shop.ini:3:11: MAIL_TO of [SHOP] needs MAIL_SERVER and MAIL_FROM."},
        {"BROKER = a\nWEBHOOK = ftp://a\n", "shop.ini:3:11: 'ftp://a' is not an http or https address."},
        {"BROKER = a\nKEEP_DAYS = -1\n", "shop.ini:3:13: [SHOP]KEEP_DAYS = -1 is out of range"},
        {"BROKER = a\nKEPT_DAYS = 1\n", "KEEP_DAYS"},
    };
    for (const auto &[text, expected] : CASES) {
        const Read found = read(std::string("[SHOP]\n") + text);
        EXPECT_NE(found.messages.find(expected), std::string::npos) << text << " gives " << found.messages;
    }
    EXPECT_NE(read("[EMC]\n").messages.find("shop.ini has no section [SHOP]."), std::string::npos);
}

TEST(ShopSettings, AreThoseOfTheFile) {
    const Read found = read(
        "[SHOP]\nBROKER = broker:1884\nNAME = hall\nGROUP = a\nGROUP = b\nKEEP_DAYS = 30\nPORT = 8100\n");
    ASSERT_TRUE(found.settings.has_value()) << found.messages;
    EXPECT_EQ(found.settings->host.name, "hall");
    EXPECT_EQ(found.settings->host.groups, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(found.settings->link.brokers.at(0).port, 1884);
    EXPECT_EQ(found.settings->store.keep_days, 30);
    EXPECT_EQ(found.settings->page.value().port, 8100);
}

}  // namespace
}  // namespace mw::shop
