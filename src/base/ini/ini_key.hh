// SPDX-License-Identifier: GPL-2.0-or-later
// A key of an INI file, declared once. Reading, the check for unknown keys and the reference page
// (docs/reference/ini.md) use the declaration.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace mw::ini {

enum class IniKind : std::uint8_t { TEXT, LIST, NUMBER, WHOLE, FLAG, CHOICE };

enum class IniEffect : std::uint8_t {
    EFFECTIVE,  ///< used by this version
    ELSEWHERE,  ///< read by HAL files, displays or other programs
    NONE,       ///< a LinuxCNC key without effect here; each setting of it is reported
};

struct IniKey {
    /// "JOINT_*" means JOINT_0, JOINT_1 ...; "AXIS_*" means AXIS_X ...; likewise "SPINDLE_*".
    std::string_view section;
    std::string_view name;
    IniKind kind = IniKind::TEXT;
    std::string_view unit{};
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    double preset = 0;         ///< default of a NUMBER, WHOLE or FLAG
    std::string_view text{};   ///< default of a TEXT or CHOICE
    std::string_view words{};  ///< words of a CHOICE, separated by blanks; of a key without effect: values
                               ///< that need no warning
    bool required = false;
    IniEffect effect = IniEffect::EFFECTIVE;
    std::string_view doc{};  ///< description; for a key without effect: the reason
};

inline constexpr double INI_UNBOUNDED = std::numeric_limits<double>::infinity();

constexpr IniKey ini_text(std::string_view section, std::string_view name, std::string_view doc,
                          std::string_view preset = {}) {
    return {.section = section, .name = name, .text = preset, .doc = doc};
}
/// May be set several times.
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
    key.required = true;
    return key;
}
constexpr IniKey ini_elsewhere(std::string_view section, std::string_view name, std::string_view doc) {
    return {.section = section, .name = name, .effect = IniEffect::ELSEWHERE, .doc = doc};
}
/// The words in `harmless` need no warning.
constexpr IniKey ini_without_effect(std::string_view section, std::string_view name, std::string_view why,
                                    std::string_view harmless = {}) {
    return {.section = section, .name = name, .words = harmless, .effect = IniEffect::NONE, .doc = why};
}

/// The row of a table; does not compile if there is none.
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
