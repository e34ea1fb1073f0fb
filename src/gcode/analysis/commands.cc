// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/commands.hh"

#include <cstdio>
#include <iostream>
#include <iterator>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "gcode/analysis/explain.hh"
#include "gcode/analysis/format.hh"

namespace mw::gcode {
namespace {

enum class FormatMode { PRINT, CHECK, IN_PLACE };

struct FormatWords {
    bool is_check = false, in_place = false;
    options::Words programs;

    options::CommandLine line() {
        options::CommandLine line("millwright format [--check | --in-place] PROGRAM.ngc|- ...",
                                  "Formats programs without changing their meaning; - is standard input.\n");
        line.flag("--check", "only list the files that would change; exit status 1 if there is one",
                  is_check);
        line.flag("--in-place", "overwrite the files", in_place);
        line.rest(programs);
        line.footer("exit status: 0 done, 1 failed, 2 wrong usage\n");
        return line;
    }
    FormatMode mode() const {
        return is_check ? FormatMode::CHECK : in_place ? FormatMode::IN_PLACE : FormatMode::PRINT;
    }
};

struct ExplainWords {
    std::string before = "F100 S1000 M3";
    options::Words line_words;

    options::CommandLine line() {
        options::CommandLine line("millwright explain [--before LINES] LINE", "Explains a line of G-code.\n");
        line.text("--before", "LINES", "lines to run first, separated by \\n (default: 'F100 S1000 M3')",
                  before);
        line.rest_of_text(line_words);
        line.footer("exit status: 0 done, 1 rejected, 2 wrong usage\n");
        return line;
    }
};

int wrong_usage(const char *command, const std::string &what) {
    language::tell(std::string("millwright ") + command + ": " + what);
    return 2;
}

Result<std::string> read_program(const std::string &path) {
    if (path == "-") {
        return std::string(std::istreambuf_iterator<char>(std::cin), {});
    }
    return read_file(path);
}

/// Formats one program; false when it cannot be read or written, or when CHECK finds a difference.
bool format_one(const std::string &path, FormatMode mode) {
    const Result<std::string> text = read_program(path);
    if (!text) {
        std::fprintf(stderr, "millwright format: %s\n", text.error().str().c_str());
        return false;
    }
    const std::string made = format_program(*text);
    const bool same = made == *text;
    if (mode == FormatMode::PRINT || (mode == FormatMode::IN_PLACE && path == "-")) {
        std::fwrite(made.data(), 1, made.size(), stdout);
        return true;
    }
    if (mode == FormatMode::CHECK) {
        if (!same) {
            std::printf("%s\n", path.c_str());
        }
        return same;
    }
    const Result<> written = same ? Result<>{} : write_file_atomically(path, made);
    if (!written) {
        std::fprintf(stderr, "millwright format: %s\n", written.error().str().c_str());
    }
    return written.has_value();
}

/// Replaces "\n", which separates blocks in a word of the shell, by newlines.
std::string with_newlines(const std::string &text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_escape = text[i] == '\\' && i + 1 < text.size() && text[i + 1] == 'n';
        out += is_escape ? '\n' : text[i];
        i += is_escape ? 1 : 0;
    }
    return out;
}

}  // namespace

int command_format(const std::vector<std::string> &arguments) {
    FormatWords words;
    if (options::wantsHelp(arguments)) {
        std::fputs(words.line().help().c_str(), stdout);
        return 0;
    }
    if (const auto parsed = words.line().parse(arguments); !parsed) {
        return wrong_usage("format", parsed.error().str());
    }
    if (words.is_check && words.in_place) {
        return wrong_usage("format", "either --check or --in-place");
    }
    if (words.programs.empty()) {
        return wrong_usage("format",
                           "needs a program: millwright format [--check | --in-place] PROGRAM.ngc|- ...");
    }
    bool good = true;
    for (const std::string &program : words.programs) {
        good = format_one(program, words.mode()) && good;
    }
    return good ? 0 : 1;
}

int command_explain(const std::vector<std::string> &arguments) {
    ExplainWords words;
    if (options::wantsHelp(arguments)) {
        std::fputs(words.line().help().c_str(), stdout);
        return 0;
    }
    if (const auto parsed = words.line().parse(arguments); !parsed) {
        return wrong_usage("explain", parsed.error().str());
    }
    if (words.line_words.empty()) {
        return wrong_usage("explain", "needs a line of G-code: millwright explain [--before LINES] LINE");
    }
    std::string line = words.line_words[0];
    for (std::size_t i = 1; i < words.line_words.size(); ++i) {
        line += ' ' + words.line_words[i];
    }
    const Explanation said = explain_line(line, with_newlines(words.before));
    std::fputs(said.text.c_str(), stdout);
    return said.isRefused ? 1 : 0;
}

}  // namespace mw::gcode
