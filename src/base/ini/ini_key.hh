// SPDX-License-Identifier: GPL-2.0-or-later
// A key of an INI file, declared once: reading it, finding unknown ones and the reference page follow from
// it (docs/reference/ini.md).
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace mw::ini {

enum class IniKind : std::uint8_t { TEXT, LIST, NUMBER, WHOLE, FLAG, CHOICE };

enum class IniEffect : std::uint8_t {
    EFFECTIVE,  ///< this version acts on it
    ELSEWHERE,  ///< HAL files, displays or other programs read it
    NONE,       ///< users of such controllers know it, and nothing acts on it: said where it is set
};

struct IniKey {
    /// "JOINT_*" stands for JOINT_0, JOINT_1 ...; "AXIS_*" for AXIS_X ...; "SPINDLE_*" likewise.
    std::string_view section;
    std::string_view name;
    IniKind kind = IniKind::TEXT;
    std::string_view unit{};
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    double preset = 0;         ///< of a NUMBER, WHOLE or FLAG
    std::string_view text{};   ///< preset of a TEXT or CHOICE
    std::string_view words{};  ///< of a CHOICE, separated by blanks; without effect: words that lose nothing
    bool isRequired = false;
    IniEffect effect = IniEffect::EFFECTIVE;
    std::string_view doc{};  ///< what it says; without effect: why it has none
};

inline constexpr double INI_UNBOUNDED = std::numeric_limits<double>::infinity();

constexpr IniKey ini_text(std::string_view section, std::string_view name, std::string_view doc,
                          std::string_view preset = {}) {
    return {.section = section, .name = name, .text = preset, .doc = doc};
}
/// May be given several times.
constexpr IniKey ini_list(std::string_view section, std::string_view name, std::string_view doc) {
    return {.section = section, .name = name, .kind = IniKind::LIST, .doc = doc};
}
struct IniRange {
    double lowest, highest;
};
constexpr IniKey ini_number(std::string_view section, std::string_view name, std::string_view unit,
                            double preset, IniRange range, std::string_view doc) {
    return {.section = section,
            .name = name,
            .kind = IniKind::NUMBER,
            .unit = unit,
            .lowest = range.lowest,
            .highest = range.highest,
            .preset = preset,
            .doc = doc};
}
constexpr IniKey ini_whole(std::string_view section, std::string_view name, std::string_view unit,
                           double preset, IniRange range, std::string_view doc) {
    IniKey key = ini_number(section, name, unit, preset, range, doc);
    key.kind = IniKind::WHOLE;
    return key;
}
/// TRUE YES ON 1 / FALSE NO OFF 0 in any case.
constexpr IniKey ini_flag(std::string_view section, std::string_view name, bool preset,
                          std::string_view doc) {
    return {
        .section = section, .name = name, .kind = IniKind::FLAG, .preset = preset ? 1.0 : 0.0, .doc = doc};
}
/// One of `words`, in any case.
constexpr IniKey ini_choice(std::string_view section, std::string_view name, std::string_view preset,
                            std::string_view words, std::string_view doc) {
    return {.section = section,
            .name = name,
            .kind = IniKind::CHOICE,
            .text = preset,
            .words = words,
            .doc = doc};
}
constexpr IniKey ini_required(IniKey key) {
    key.isRequired = true;
    return key;
}
constexpr IniKey ini_elsewhere(std::string_view section, std::string_view name, std::string_view doc) {
    return {.section = section, .name = name, .effect = IniEffect::ELSEWHERE, .doc = doc};
}
/// With one of the words `harmless` nothing is lost.
constexpr IniKey ini_without_effect(std::string_view section, std::string_view name, std::string_view why,
                                    std::string_view harmless = {}) {
    return {.section = section, .name = name, .words = harmless, .effect = IniEffect::NONE, .doc = why};
}

/// The row of a table; does not compile where there is none.
template <class Table>
consteval const IniKey &row_of(const Table &table, std::string_view section, std::string_view name) {
    for (const IniKey &key : table) {
        if (key.section == section && key.name == name) {
            return key;
        }
    }
    throw std::invalid_argument("the table does not declare this key");
}

}  // namespace mw::ini
