// SPDX-License-Identifier: GPL-2.0-or-later
// Pin tables (hal/sdk/pin_table.hh) as rows of text, to be compared with a manual page and with HAL.
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "hal/core/instance.hh"
#include "hal/sdk/pin_table.hh"

namespace mw::testing {

struct PinText {
    std::string name;  ///< as the manual page has it: joint.N.pos-cmd, motion.digital-in-NN, axis.L.pos-cmd
    hal::Type type = hal::Type::BIT;
    hal::Dir dir = hal::Dir::IN;
    double start = 0;
    std::string unit, doc;
};

inline std::string replaced(std::string text, const std::string &from, const std::string &to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

/// Rows of all tables that `for_each` passes.
template <class ForEach>
std::vector<PinText> pin_texts(const ForEach &for_each) {
    std::vector<PinText> out;
    for_each([&](const char *scope, const auto &row) {
        using Pin = std::remove_cvref_t<decltype(row)>;
        const std::string name = std::string(scope) + '.' + row.name;
        out.push_back({replaced(replaced(name, "#", "N"), "@", "L"),
                       static_cast<hal::Type>(sdk::type_of<typename Pin::Value>()),
                       static_cast<hal::Dir>(Pin::DIRECTION), static_cast<double>(row.start), row.unit,
                       row.doc});
    });
    return out;
}

inline std::string number_text(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// The line of the manual page, in the form of scdoc.
inline std::string page_line(const PinText &row) {
    std::string dir = hal::dir_name(row.dir);
    std::transform(dir.begin(), dir.end(), dir.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    std::string line =
        '*' + replaced(row.name, "_", "\\_") + "* " + hal::type_name(row.type) + ' ' + replaced(dir, "/", "");
    const bool isBit = row.type == hal::Type::BIT;
    line += row.start == 0 ? "" : isBit ? " (default: TRUE)" : " (default: " + number_text(row.start) + ")";
    line += ": " + replaced(row.doc, "_", "\\_");
    return line + (row.unit.empty() ? "" : " \\[" + row.unit + "]") + "++";
}

/// The lines about pins after "# PINS" of a manual page.
inline std::vector<std::string> page_pins(const std::string &path) {
    std::ifstream page(path);
    std::vector<std::string> lines;
    bool isPins = false;
    for (std::string line; std::getline(page, line);) {
        isPins = line.starts_with("# ") ? line == "# PINS" : isPins;
        if (isPins && line.starts_with("*")) {
            lines.push_back(line);
        }
    }
    return lines;
}

}  // namespace mw::testing
