// SPDX-License-Identifier: GPL-2.0-or-later
#include <map>

#include <gtest/gtest.h>

#include "base/language/language.hh"

namespace mw::language {
namespace {

using Names = std::vector<std::string>;

Names wanted_with(const std::map<std::string, std::string> &environment) {
    return wanted([&environment](const char *name) {
        const auto found = environment.find(name);
        return found == environment.end() ? nullptr : found->second.c_str();
    });
}

TEST(Language, ThatOfTheLocaleIsWanted) {
    EXPECT_EQ(wanted_with({{"LANG", "de_AT.UTF-8"}}), (Names{"de_AT", "de"}));
    EXPECT_EQ(wanted_with({{"LANG", "de_DE"}, {"LC_MESSAGES", "es_ES@euro"}}), (Names{"es_ES", "es"}));
    EXPECT_EQ(wanted_with({{"LANG", "de_DE"}, {"LC_ALL", "es"}}), (Names{"es"}));
}

TEST(Language, ThoseOfAListComeInItsOrderUpToEnglish) {
    EXPECT_EQ(wanted_with({{"LANG", "en_US.UTF-8"}, {"LANGUAGE", "es:de"}}), (Names{"es", "de"}));
    EXPECT_EQ(wanted_with({{"LANG", "de_DE.UTF-8"}, {"LANGUAGE", "en_GB:de"}}), Names{});
    EXPECT_EQ(wanted_with({{"LANG", "de_DE.UTF-8"}, {"LANGUAGE", "../de:es"}}), (Names{"es"}));
}

TEST(Language, PlainLocalesAreEnglish) {
    EXPECT_EQ(wanted_with({}), Names{});
    EXPECT_EQ(wanted_with({{"LANG", "C"}, {"LANGUAGE", "de"}}), Names{});
    EXPECT_EQ(wanted_with({{"LC_ALL", "C.UTF-8"}, {"LANG", "de_DE.UTF-8"}}), Names{});
}

}  // namespace
}  // namespace mw::language
