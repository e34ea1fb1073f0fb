// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/tools/life.hh"

#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::tools {
namespace {

constexpr const char *HEAD = "; life of tools: seconds and machine units in cut\n";

/// A number that is not negative; -1 for any other text.
double amount(std::string_view text) {
    const auto value = parse_double(text);
    return value.has_value() && std::isfinite(*value) && *value >= 0 ? *value : -1.0;
}

}  // namespace

Result<LifeBook> LifeBook::parse(std::string_view text, const std::string &path) {
    constexpr std::size_t WORDS = 3;
    constexpr double MOST = 99999999;
    LifeBook book;
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::vector<std::string> words = split_words(line);
        if (words.empty() || words.front().starts_with(';')) {
            continue;
        }
        const bool is_tool = words.size() == WORDS && words[0].starts_with('T');
        const double tool = is_tool ? amount(std::string_view(words[0]).substr(1)) : -1.0;
        const CutLife life{is_tool ? amount(words[1]) : -1.0, is_tool ? amount(words[2]) : -1.0};
        if (tool < 0 || tool > MOST || tool != std::floor(tool) || life.time_s < 0 || life.length < 0) {
            return fail("a tool life line is 'T<number> <seconds> <length>'", {path, number, 1});
        }
        book.add(static_cast<int>(tool), life);
    }
    return book;
}

void LifeBook::add(int toolno, const CutLife &cut) {
    CutLife &mine = tools_[toolno];
    mine.time_s += cut.time_s;
    mine.length += cut.length;
}

CutLife LifeBook::of(int toolno) const {
    const auto found = tools_.find(toolno);
    return found == tools_.end() ? CutLife{} : found->second;
}

std::string LifeBook::text() const {
    std::string out = HEAD;
    for (const auto &[number, life] : tools_) {
        out += fmt::format("T{} {:.3f} {:.4f}\n", number, life.time_s, life.length);
    }
    return out;
}

}  // namespace mw::tools
