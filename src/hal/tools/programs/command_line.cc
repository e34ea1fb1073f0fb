// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/programs/command_line.hh"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "base/options/letters.hh"
#include "hal/script/completion.hh"
#include "hal/tools/programs/line_editor.hh"

namespace mw::hal::tools {

namespace {

void apply(CommandLine &line, const options::Letter &option) {
    script::SessionOptions &session = line.session;
    switch (option.letter) {
    case 'f': line.readsInput = session.are_pipes_read = true; break;
    case 'k': session.keepsGoing = true; break;
    case 'q': session.verbosity = script::Verbosity::ERRORS; break;
    case 'Q': session.verbosity = script::Verbosity::SILENT; break;
    case 's': session.is_script = true; break;
    case 'v': session.verbosity = script::Verbosity::RESULTS; break;
    case 'V': session.verbosity = script::Verbosity::EVERYTHING; break;
    case 'e': session.isEchoing = true; break;
    case 'h': line.wants_help = true; break;
    case 'I': line.interactive = true; break;
    case 'U': line.killing = true; break;
    case 'T': line.wants_tcl = true; break;
    case 'i': line.ini_path = option.value; break;
    default:
        break;  // R has no effect: the lock of the HAL segment is robust and is released when its holder dies
    }
}

}  // namespace

Result<CommandLine> parse_command_line(const std::vector<std::string> &arguments) {
    static constexpr options::KnownLetter KNOWN[] = {
        {'f'}, {'k'}, {'q'}, {'Q'}, {'s'}, {'v'}, {'V'},
        {'e'}, {'h'}, {'I'}, {'U'}, {'T'}, {'R'}, {'i', "the name of an INI file"}};
    auto read = options::read_letters(arguments, KNOWN, options::EndOfLetters::FIRST_WORD);
    if (!read) {
        return std::unexpected(read.error());
    }
    CommandLine line;
    for (const options::Letter &option : read->options) {
        apply(line, option);
    }
    line.words = std::move(read->words);
    line.session.library = script::default_library();
    return line;
}

Result<> IniOption::load(const std::string &path) {
    if (path.empty()) {
        return {};
    }
    Result<ini::IniFile> file = ini::IniFile::load(path, sink_);
    if (!file) {
        return std::unexpected(file.error());
    }
    if (sink_.count_errors() > 0) {
        return fail(fmt::format("INI file '{}' has errors", path));
    }
    file_ = std::make_unique<ini::IniFile>(std::move(*file));
    lookup_ = std::make_unique<script::IniFileLookup>(*file_);
    return {};
}

namespace {

/// Reads lines of standard input, with a line editor at a terminal.
class InputLines {
  public:
    explicit InputLines(script::Session &session) : is_terminal_(isatty(STDIN_FILENO) == 1) {
        if (is_terminal_) {
            LineEditorOptions options;
            options.history_file = history_file("halcmd");
            options.complete = [&session](const std::string &line) {
                return script::completions(session, line);
            };
            options.stop = session.options().stop;
            editor_ = std::make_unique<LineEditor>(std::move(options));
        }
    }
    bool isTerminal() const { return is_terminal_; }
    /// The next line. `continued`: the line continues the previous line.
    std::optional<std::string> next(bool continued) {
        if (editor_ != nullptr) {
            return editor_->read(continued ? "      > " : "halcmd: ");
        }
        std::string line;
        return std::getline(std::cin, line) ? std::optional(line) : std::nullopt;
    }

  private:
    bool is_terminal_;
    std::unique_ptr<LineEditor> editor_;
};

}  // namespace

Result<> run_standard_input(script::Session &session) {
    InputLines lines(session);
    Result<> first;
    std::string text;
    int number = 0;      // number of lines read
    int first_line = 1;  // first line of the current command
    while (!session.hasEnded()) {
        const std::optional<std::string> line = lines.next(!text.empty());
        if (!line) {
            break;
        }
        ++number;
        first_line = text.empty() ? number : first_line;
        text += *line;
        if (!text.empty() && text.back() == '\\') {
            text += '\n';
            continue;
        }
        const Result<> result = session.run_text(text, lines.isTerminal() ? "" : "stdin", first_line);
        text.clear();
        first = first ? result : first;
        const bool goesOn = lines.isTerminal() || session.options().keepsGoing;
        if (!result && !goesOn) {
            break;
        }
    }
    if (!lines.isTerminal()) {
        return first;
    }
    if (!session.hasEnded()) {
        std::fputc('\n', stdout);
    }
    return {};
}

}  // namespace mw::hal::tools
