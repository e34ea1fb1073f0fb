// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/abilities.hh"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

namespace mw::machine {
namespace {

constexpr std::array MISSING{
    MissingAbility{gcode::PreviewKind::RIGID_TAP, "G33.1", "tap rigidly where joints are not axes",
                   "tap with G84 and a floating holder, or cut the thread with G33 or G76", true},
};

bool isBlank(char c) {
    return c == ' ' || c == '\t';
}

/// Whether the code stands at the front of `text`, blanks and leading zeros apart, and does not go on.
bool beginsWith(std::string_view text, std::string_view code) {
    bool isNumber = false;
    for (const char c : code) {
        while (!text.empty() && (isBlank(text[0]) || (isNumber && c != '0' && text[0] == '0'))) {
            text.remove_prefix(1);
        }
        if (text.empty() || std::toupper(static_cast<unsigned char>(text[0])) != c) {
            return false;
        }
        text.remove_prefix(1);
        isNumber = c == 'G' || c == 'M';
    }
    return text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) == 0;
}

}  // namespace

const MissingAbility *missing_ability(const gcode::PreviewEvent &event, bool areJointsAxes) {
    const auto found = std::ranges::find(MISSING, event.kind, &MissingAbility::kind);
    const bool isMissing = found != MISSING.end() && !(found->isForAxes && areJointsAxes);
    return isMissing ? &*found : nullptr;
}

int column_of_code(std::string_view line, std::string_view code) {
    bool isComment = false;
    for (std::size_t i = 0; i < line.size() && line[i] != ';'; ++i) {
        isComment = line[i] == '(' || (isComment && line[i] != ')');
        if (!isComment && !isBlank(line[i]) && beginsWith(line.substr(i), code)) {
            return static_cast<int>(i) + 1;
        }
    }
    return 1;
}

}  // namespace mw::machine
