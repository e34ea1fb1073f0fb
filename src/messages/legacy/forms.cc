// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/legacy/forms.hh"

#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"
#include "messages/legacy/units.hh"

namespace mw::legacy {
namespace {

struct Words {
    const char *on, *off;
};

constexpr Words ON{"ON", "OFF"}, YES{"YES", "NO"}, ONE{"1", "0"}, HOMED{"homed", "not"};

Words words_of(Form form, Dialect dialect) {
    const bool tcl = dialect == Dialect::TCL, newer = dialect == Dialect::RSH;
    switch (form) {
    case Form::ON_OFF: return ON;
    case Form::SWITCH: return newer ? ON : ONE;
    case Form::TELEOP: return newer ? ON : tcl ? ONE : YES;
    case Form::YES_NO: return newer ? YES : ONE;
    case Form::HOMED: return tcl ? HOMED : YES;
    default: return ONE;
    }
}

}  // namespace

std::string text(Form form, Dialect dialect, bool value) {
    const Words words = words_of(form, dialect);
    return text(Form::WORD, dialect, std::string(value ? words.on : words.off));
}

std::string text(Form form, Dialect dialect, std::int64_t value) {
    return form == Form::BITS && dialect == Dialect::RSH ? fmt::format("0x{:08x}", value)
                                                         : std::to_string(value);
}

std::string text(Form form, Dialect dialect, double value) {
    const double shown = form == Form::PERCENT ? percent(value) : value;
    switch (dialect) {
    case Dialect::RSH: break;
    case Dialect::OLD_RSH:
        return form == Form::PERCENT ? fmt::format("{:.0f}", shown) : fmt::format("{:f}", shown);
    case Dialect::TCL: return std::to_string(std::lround(shown));
    }
    return fmt::format("{:f}", shown);
}

std::string text(Form form, Dialect dialect, const std::string &value) {
    const bool empty = form == Form::PATH && value.empty();
    const std::string shown = empty ? "NONE" : value;
    return dialect == Dialect::TCL && (form != Form::PATH || empty) ? to_lower(shown) : shown;
}

}  // namespace mw::legacy
