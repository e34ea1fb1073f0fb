// SPDX-License-Identifier: GPL-2.0-or-later
#include <chrono>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/tcl/commands.hh"

namespace mw::tcl {
namespace {

using Text = Result<std::string>;

/// The value of KEY SECTION, else the default, else nothing.
std::optional<std::string> entry(const Shell &shell, const Words &words) {
    constexpr std::size_t DEFAULT = 2;
    const ini::IniEntry *const found = shell.ini().find(words[1], words[0]);
    if (found != nullptr) {
        return found->value;
    }
    return words.size() > DEFAULT ? std::optional(words[DEFAULT]) : std::nullopt;
}

std::unexpected<Error> missing(const Words &words) {
    return fail(fmt::format("[{}]{} is not in the INI file", printable(words[1]), printable(words[0])));
}

std::unexpected<Error> no_value(const Words &words, const std::string &value, const char *kind) {
    return fail(fmt::format("[{}]{} = {} is not {}", printable(words[1]), printable(words[0]),
                            printable(value), kind));
}

Text ini_text(Shell &shell, const Words &words) {
    return entry(shell, words).value_or("");
}

Text ini_real(Shell &shell, const Words &words) {
    const auto value = entry(shell, words);
    if (!value.has_value()) {
        return missing(words);
    }
    const auto number = parse_double(*value);
    return number.has_value() ? Text(fmt::format("{}", *number)) : no_value(words, *value, "a number");
}

Text ini_whole(Shell &shell, const Words &words) {
    const auto value = entry(shell, words);
    if (!value.has_value()) {
        return missing(words);
    }
    const auto number = parse_int(*value);
    return number.has_value() ? Text(std::to_string(*number)) : no_value(words, *value, "a whole number");
}

Text ini_flag(Shell &shell, const Words &words) {
    const auto value = entry(shell, words);
    if (!value.has_value()) {
        return missing(words);
    }
    const auto flag = rsh::one_of<bool>(*value, {{"TRUE", true},
                                                 {"YES", true},
                                                 {"ON", true},
                                                 {"1", true},
                                                 {"FALSE", false},
                                                 {"NO", false},
                                                 {"OFF", false},
                                                 {"0", false}});
    return flag.has_value() ? Text(*flag ? "1" : "0") : no_value(words, *value, "yes or no");
}

/// An element of a Tcl list: in braces, or with a backslash before each special character.
std::string element(const std::string &text) {
    int depth = 0;
    bool plain = text.find('\\') == std::string::npos;
    for (const char c : text) {
        depth += c == '{' ? 1 : c == '}' ? -1 : 0;
        plain = plain && depth >= 0;
    }
    if (plain && depth == 0) {
        return "{" + text + "}";
    }
    constexpr std::string_view SPECIAL = "{}[]$\\\"; \t";
    std::string out;
    for (const char c : text) {
        out += SPECIAL.find(c) == std::string_view::npos ? std::string(1, c) : std::string{'\\', c};
    }
    return out;
}

Text ini_sections(Shell &shell, const Words &) {
    std::string list;
    for (const std::string &section : shell.ini().sections()) {
        list += (list.empty() ? "" : " ") + element(section);
    }
    return list;
}

Text ini_variables(Shell &shell, const Words &words) {
    std::string list;
    for (const std::string &key : shell.ini().keys(words[0])) {
        for (const ini::IniEntry *const one : shell.ini().find_all(words[0], key)) {
            list += (list.empty() ? "" : " ") + element(key + " " + element(one->value));
        }
    }
    return list;
}

Text ini_load(Shell &shell, const Words &words) {
    diagnostics::Sink quiet([](const diagnostics::Diagnostic &) {});
    std::error_code ignored;
    auto loaded = ini::IniFile::load(std::filesystem::absolute(words[0], ignored).string(), quiet);
    if (!loaded.has_value()) {
        return std::unexpected(loaded.error());
    }
    shell.set_ini(std::move(*loaded));
    return "";
}

Text set_wait(Shell &shell, const Words &words) {
    if (words.empty()) {
        return shell.own.waiting_for_done ? "done" : "received";
    }
    const auto isDone = rsh::one_of<bool>(words[0], {{"received", false}, {"done", true}});
    if (!isDone.has_value()) {
        return std::unexpected(isDone.error());
    }
    shell.own.waiting_for_done = *isDone;
    return "";
}

Text wait(Shell &shell, const Words &words) {
    const auto isDone = rsh::one_of<bool>(words[0], {{"received", false}, {"done", true}});
    return isDone.has_value() ? shell.wait(*isDone) : std::unexpected(isDone.error());
}

Text set_timeout(Shell &shell, const Words &words) {
    if (words.empty()) {
        return fmt::format("{:.1f}", shell.own.timeout_s);
    }
    const auto seconds = parse_double(words[0]);
    if (!seconds.has_value() || !(*seconds >= 0)) {
        return fail("a timeout is a number of seconds, 0 for ever");
    }
    shell.own.timeout_s = *seconds;
    return "";
}

Text update(Shell &shell, const Words &words) {
    if (!words.empty()) {
        const auto isAuto = rsh::one_of<bool>(words[0], {{"none", false}, {"auto", true}});
        if (!isAuto.has_value()) {
            return std::unexpected(isAuto.error());
        }
        shell.own.updating = *isAuto;
        shell.own.kept = *isAuto ? nullptr : std::make_unique<messages::MachineStatus>(shell.status());
        return "";
    }
    const auto read = shell.update();
    return read.has_value() ? Text("") : std::unexpected(read.error());
}

Text time(Shell &, const Words &) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return fmt::format("{:f}", std::chrono::duration<double>(now).count());
}

Text conversion(Shell &shell, const Words &words, const char *name) {
    if (!words.empty()) {
        return shell.ask(name, words);
    }
    const auto text = shell.told(name);
    return text.has_value() ? Text(to_lower(*text)) : text;
}

Text linear_conversion(Shell &shell, const Words &words) {
    return conversion(shell, words, "LINEAR_UNIT_CONVERSION");
}

Text angular_conversion(Shell &shell, const Words &words) {
    return conversion(shell, words, "ANGULAR_UNIT_CONVERSION");
}

Text rounded(const Words &words, double (*round)(double)) {
    const auto value = parse_double(words[0]);
    constexpr double MOST = 9e15;
    return value.has_value() && std::fabs(*value) < MOST
               ? Text(std::to_string(static_cast<std::int64_t>(round(*value))))
               : fail(fmt::format("'{}' is not a number", printable(words[0])));
}

constexpr const char *KEY = "key section [default]";

constexpr CommandRow ROWS[] = {
    {"emc_angular_unit_conversion", 0, 1, "[deg|rad|grad|auto|custom]", angular_conversion},
    {"emc_ini", 2, 3, KEY, ini_text},
    {"emc_ini_bool", 2, 3, KEY, ini_flag},
    {"emc_ini_filename", 0, 0, "", [](Shell &s, const Words &) { return Text(s.ini().path()); }},
    {"emc_ini_int", 2, 3, KEY, ini_whole},
    {"emc_ini_load", 1, 1, "file", ini_load},
    {"emc_ini_real", 2, 3, KEY, ini_real},
    {"emc_ini_sections", 0, 0, "", ini_sections},
    {"emc_ini_variables", 1, 1, "section", ini_variables},
    {"emc_ini_wideint", 2, 3, KEY, ini_whole},
    {"emc_linear_unit_conversion", 0, 1, "[inch|mm|cm|auto|custom]", linear_conversion},
    {"emc_pendant", 1, 1, "port",
     [](Shell &, const Words &) {
         return Text(fail("there is no pendant at a serial port or the printer's: take a HAL component"));
     }},
    {"emc_plat", 0, 0, "", [](Shell &, const Words &) { return Text("Linux"); }},
    {"emc_set_timeout", 0, 1, "[seconds]", set_timeout},
    {"emc_set_wait", 0, 1, "[received|done]", set_wait},
    {"emc_time", 0, 0, "", time},
    {"emc_update", 0, 1, "[none|auto]", update},
    {"emc_wait", 1, 1, "received|done", wait},
    {"int", 1, 1, "number", [](Shell &, const Words &w) { return rounded(w, std::trunc); }},
    {"round", 1, 1, "number", [](Shell &, const Words &w) { return rounded(w, std::round); }},
};

}  // namespace

std::span<const CommandRow> settings() {
    return ROWS;
}

}  // namespace mw::tcl
