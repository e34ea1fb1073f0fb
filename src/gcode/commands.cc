// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/commands.hh"

#include <cstdio>
#include <iostream>
#include <iterator>

#include "base/atomic_file.hh"
#include "gcode/explain.hh"
#include "gcode/format.hh"

namespace mw::gcode {
namespace {

constexpr const char *FORMAT_USAGE =
    "usage: millwright format [--check | --in-place] PROGRAM.ngc|- ...\n"
    "  writes programs in one form, without a change of meaning\n"
    "  --check     only say which ones would change; status 1 when any would\n"
    "  --in-place  write them back\n";
constexpr const char *EXPLAIN_USAGE =
    "usage: millwright explain [--before LINES] LINE\n"
    "  says in words what a line of G-code does\n"
    "  --before    lines to run first, one after the other with \\n between (default: 'F100 S1000 M3')\n";
constexpr const char *DEFAULT_BEFORE = "F100 S1000 M3";

bool wantsHelp(const std::vector<std::string> &words) {
    return !words.empty() && (words[0] == "--help" || words[0] == "-h");
}

Result<std::string> read_program(const std::string &path) {
    if (path == "-") {
        return std::string(std::istreambuf_iterator<char>(std::cin), {});
    }
    return read_file(path);
}

enum class FormatMode { PRINT, CHECK, IN_PLACE };

/// One program; false when it cannot be read or written, or would change under CHECK.
bool format_one(const std::string &path, FormatMode mode) {
    const Result<std::string> text = read_program(path);
    if (!text) {
        std::fprintf(stderr, "millwright format: %s\n", text.error().str().c_str());
        return false;
    }
    const std::string made = format_program(*text);
    const bool isSame = made == *text;
    if (mode == FormatMode::PRINT || (mode == FormatMode::IN_PLACE && path == "-")) {
        std::fwrite(made.data(), 1, made.size(), stdout);
        return true;
    }
    if (mode == FormatMode::CHECK) {
        if (!isSame) {
            std::printf("%s\n", path.c_str());
        }
        return isSame;
    }
    const Result<> written = isSame ? Result<>{} : write_file_atomically(path, made);
    if (!written) {
        std::fprintf(stderr, "millwright format: %s\n", written.error().str().c_str());
    }
    return written.has_value();
}

/// Blocks on one line are written "\n" in the shell.
std::string with_newlines(const std::string &text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isEscape = text[i] == '\\' && i + 1 < text.size() && text[i + 1] == 'n';
        out += isEscape ? '\n' : text[i];
        i += isEscape ? 1 : 0;
    }
    return out;
}

}  // namespace

int command_format(const std::vector<std::string> &words) {
    if (wantsHelp(words)) {
        std::fputs(FORMAT_USAGE, stdout);
        return 0;
    }
    FormatMode mode = FormatMode::PRINT;
    std::vector<std::string> files;
    for (const std::string &word : words) {
        if (word == "--check") {
            mode = FormatMode::CHECK;
        } else if (word == "--in-place") {
            mode = FormatMode::IN_PLACE;
        } else if (word.size() > 1 && word[0] == '-') {
            std::fprintf(stderr, "millwright format: unknown option '%s'\n%s", word.c_str(), FORMAT_USAGE);
            return 2;
        } else {
            files.push_back(word);
        }
    }
    if (files.empty()) {
        std::fputs(FORMAT_USAGE, stderr);
        return 2;
    }
    bool isGood = true;
    for (const std::string &file : files) {
        isGood = format_one(file, mode) && isGood;
    }
    return isGood ? 0 : 1;
}

int command_explain(const std::vector<std::string> &words) {
    if (wantsHelp(words)) {
        std::fputs(EXPLAIN_USAGE, stdout);
        return 0;
    }
    std::string before = DEFAULT_BEFORE, line;
    bool isWrong = words.empty(), hasLine = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--before" && i + 1 < words.size()) {
            before = with_newlines(words[++i]);
        } else if (words[i].substr(0, 2) == "--") {
            isWrong = true;
        } else {
            line += (hasLine ? " " : "") + words[i];
            hasLine = true;
        }
    }
    if (isWrong || !hasLine) {
        std::fputs(EXPLAIN_USAGE, stderr);
        return 2;
    }
    const Explanation said = explain_line(line, before);
    std::fputs(said.text.c_str(), stdout);
    return said.isRefused ? 1 : 0;
}

}  // namespace mw::gcode
