// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/meters.hh"

#include <unistd.h>

#include <cstdio>

#include "base/language/language.hh"
#include "base/text.hh"
#include "hal/tools/view/commands.hh"

namespace mw::hal::view {

std::vector<std::string> meter_words(const std::vector<std::string> &words, bool is_terminal, bool &wrong) {
    std::vector<std::string> names;
    wrong = false;
    for (std::size_t i = 0; i < words.size() && !wrong; ++i) {
        const std::string &word = words[i];
        const bool has_next = i + 1 < words.size();
        if (word == "-s") {
            continue;  // -s, a small window, has no effect
        }
        if (word == "-g") {  // -g, the position on the screen, has no effect
            while (i + 1 < words.size() && parse_int(words[i + 1]).has_value()) {
                ++i;
            }
        } else if (word == "pin" || word == "sig" || word == "signal" || word == "param" || word == "par") {
            wrong = !has_next;
            names.push_back(has_next ? words[++i] : "");
        } else {
            wrong = true;
        }
    }
    if (!is_terminal) {
        names.insert(names.begin(), "watch");
    }
    return names;
}

namespace {

constexpr const char *METER_USAGE = "usage: halmeter [-s] [pin|sig|param NAME] [-g X Y [WIDTH]]\n"
                                    "  shows it on the terminal (as `millwright hal NAME`), elsewhere as "
                                    "lines of text; there is no window:\n"
                                    "  -s and -g have no effect\n";
constexpr const char *SCOPE_TEXT =
    "halscope: there is no oscilloscope in a window. `millwright hal capture NAME... --help` records up to "
    "16\n"
    "pins, signals and parameters in realtime, with triggers, as CSV, PNG or SVG.\n";

bool wantsHelp(const std::vector<std::string> &words) {
    return words.size() == 1 && (words[0] == "--help" || words[0] == "-h");
}

}  // namespace

int halmeter(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop) {
    bool wrong = false;
    const std::vector<std::string> wanted = meter_words(words, ::isatty(STDOUT_FILENO) != 0, wrong);
    if (wrong) {
        std::fputs(language::shown(METER_USAGE).c_str(), wantsHelp(words) ? stdout : stderr);
        return wantsHelp(words) ? 0 : 2;
    }
    return command_hal(wanted, stop);
}

int halscope(const std::vector<std::string> &words) {
    std::fputs(language::shown(SCOPE_TEXT).c_str(), wantsHelp(words) ? stdout : stderr);
    return wantsHelp(words) ? 0 : 1;
}

}  // namespace mw::hal::view
