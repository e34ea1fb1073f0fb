// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the built catalogues as gettext does, and searches them for messages of the machine.
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include <gtest/gtest.h>

#include "base/language/catalogue.hh"

namespace mw::language {
namespace {

std::string bytes_of(const std::string &language) {
    std::ifstream file(std::string(MW_LOCALE) + "/" + language + "/LC_MESSAGES/millwright.mo",
                       std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Catalogue of(const std::string &language) {
    auto read = Catalogue::read(bytes_of(language));
    EXPECT_TRUE(read.has_value());
    return read.value_or(Catalogue{});
}

/// A gettext catalogue of these texts.
Catalogue made_of(const std::map<std::string, std::string> &texts) {
    std::string head, strings;
    const auto number = [](std::size_t value) {
        const auto small = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char *>(&small), sizeof small);
    };
    const std::size_t rows = texts.size(), begin = 20, end = begin + 16 * rows;
    const auto table = [&](auto member) {
        for (const auto &entry : texts) {
            head += number(member(entry).size()) + number(end + strings.size());
            strings += member(entry) + '\0';
        }
    };
    table([](const auto &entry) { return entry.first; });
    table([](const auto &entry) { return entry.second; });
    auto read = Catalogue::read(number(0x950412de) + number(0) + number(rows) + number(begin) +
                                number(begin + 8 * rows) + head + strings);
    EXPECT_TRUE(read.has_value());
    return read.value_or(Catalogue{});
}

TEST(Catalogue, WhatIsPutInStandsWhereTheTranslationHasIt) {
    const Catalogue one =
        made_of({{"{} of {} things", "{1} Dinge, davon {0}"}, {"joint {} moves", "Gelenk {} fährt"}});
    EXPECT_EQ(one.find("3 of 17 things"), "17 Dinge, davon 3");
    EXPECT_EQ(one.find("joint 2 moves"), "Gelenk 2 fährt");
    EXPECT_EQ(one.find("joint 2 moves fast"), std::nullopt);
    EXPECT_EQ(one.find("a joint 2 moves"), std::nullopt);
}

TEST(Catalogue, TheTextWithMoreLettersOfItsOwnIsTheOneThatIsMeant) {
    const Catalogue one = made_of({{"{} of {}", "allgemein"}, {"speed of {}", "Geschwindigkeit von {}"}});
    EXPECT_EQ(one.find("speed of X"), "Geschwindigkeit von X");
    EXPECT_EQ(one.find("jerk of X"), "allgemein");
}

TEST(Catalogue, ValuesThatAreTextsAreTranslatedAndNamesAreNot) {
    const Catalogue one = made_of({{"cannot open {}", "{} geht nicht auf"}, {"the machine", "die Maschine"}});
    EXPECT_EQ(one.find("cannot open the machine"), "die Maschine geht nicht auf");
    EXPECT_EQ(one.find("cannot open the_machine.ini"), "the_machine.ini geht nicht auf");
}

TEST(Catalogue, TheCasesThatTheScreenHasTooAreShownAlike) {
    std::ifstream file(std::string(MW_PO) + "/cases.json");
    const auto cases = nlohmann::json::parse(file);
    for (const auto &[language, texts] : cases.items()) {
        const Catalogue one = of(language);
        for (const auto &[english, shown] : texts.items()) {
            EXPECT_EQ(one.shown(english), shown.get<std::string>());
        }
    }
}

TEST(Catalogue, ProgramNameAndNewlineStay) {
    EXPECT_EQ(of("de").shown("millwright run: unknown option --plto (did you mean --plot?)\n"),
              "millwright run: unbekannte Option --plto (war --plot gemeint?)\n");
}

/// `text` with the values inserted for {} and {0}, {1}. Implemented independently of the catalogue.
std::string put_in(std::string text, const std::vector<std::string> &values) {
    std::size_t next = 0;
    for (std::size_t at = text.find('{'); at != std::string::npos; at = text.find('{', at)) {
        const std::size_t end = text.find('}', at);
        const std::string inside = text.substr(at + 1, end - at - 1);
        if (!inside.empty() && inside.find_first_not_of("0123456789") != std::string::npos) {
            ++at;
            continue;
        }
        const std::string &value = values.at(inside.empty() ? next++ : std::stoul(inside));
        text.replace(at, end - at + 1, value);
        at += value.size();
    }
    return text;
}

/// Keys and translations of a catalogue with one string per line.
std::vector<std::pair<std::string, std::string>> texts_of(const std::string &language) {
    std::ifstream file(std::string(MW_PO) + "/" + language + ".po");
    std::vector<std::pair<std::string, std::string>> texts;
    for (std::string line; std::getline(file, line);) {
        const std::size_t from = line.find('"');
        std::string text = from == std::string::npos ? "" : line.substr(from + 1, line.size() - from - 2);
        for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
            text.erase(at, 1);
            text[at] = text[at] == 'n' ? '\n' : text[at];
        }
        if (line.starts_with("msgid ")) {
            texts.emplace_back(text, "");
        } else if (line.starts_with("msgstr ") && !texts.empty()) {
            texts.back().second = text;
        }
    }
    return texts;
}

TEST(Catalogue, EachTextIsFoundAgainWithWhateverIsPutIntoIt) {
    for (const char *language : {"de", "es"}) {
        const Catalogue one = of(language);
        const auto texts = texts_of(language);
        ASSERT_GT(texts.size(), 900U);
        const std::vector<std::string> values{"17", "x-axis.ngc", "-0.5", "Q7", "b", "9",
                                              "z",  "3",          "4",    "k",  "1", "2"};
        int others = 0;
        for (std::size_t i = 1; i < texts.size(); ++i) {
            const auto &[key, translation] = texts[i];
            const auto found = one.find(put_in(key, values));
            ASSERT_TRUE(found.has_value()) << key;
            others += *found != put_in(translation, values)
                          ? 1
                          : 0;  // another text with the same number of letters also matches
        }
        EXPECT_LT(others, 8) << language;
    }
}

TEST(Catalogue, AMessageOfManyUnknownPartsIsShownAtOnce) {
    const Catalogue one = of("de");
    std::string text;
    for (int i = 0; i < 400; ++i) {
        text += "word" + std::to_string(i) + (i % 3 == 0 ? ": " : i % 3 == 1 ? " (what) " : "; ");
    }
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(one.shown(text), text);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(Catalogue, WithoutALanguageATextStaysAsItIs) {
    EXPECT_EQ(Catalogue{}.shown("a.ngc:1: error: the machine is not on"),
              "a.ngc:1: error: the machine is not on");
}

TEST(Catalogue, ADamagedFileIsAnErrorAtEachLength) {
    const std::string whole = bytes_of("de");
    ASSERT_GT(whole.size(), 1000U);
    EXPECT_FALSE(Catalogue::read("").has_value());
    for (std::size_t length = 0; length < whole.size(); length += 97) {
        EXPECT_FALSE(Catalogue::read(std::string_view(whole).substr(0, length)).has_value()) << length;
    }
    std::string bad = whole;
    for (std::size_t at = 8; at < 400; ++at) {  // counts, tables and rows
        bad[at] = static_cast<char>(bad[at] ^ 0x7f);
        static_cast<void>(Catalogue::read(bad));  // checks only that read() returns
        bad[at] = whole[at];
    }
}

}  // namespace
}  // namespace mw::language
