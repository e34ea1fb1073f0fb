// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/programs/command_line.hh"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "hal_lang/lang/completion.hh"
#include "hal_tools/programs/line_editor.hh"
#include "options/letters.hh"

namespace mw::hal::tools {

namespace {

void apply(CommandLine &line, const options::Letter &option) {
    lang::SessionOptions &session = line.session;
    switch (option.letter) {
    case 'f': line.readsInput = session.arePipesRead = true; break;
    case 'k': session.keepsGoing = true; break;
    case 'q': session.verbosity = lang::Verbosity::ERRORS; break;
    case 'Q': session.verbosity = lang::Verbosity::SILENT; break;
    case 's': session.isScript = true; break;
    case 'v': session.verbosity = lang::Verbosity::RESULTS; break;
    case 'V': session.verbosity = lang::Verbosity::EVERYTHING; break;
    case 'e': session.isEchoing = true; break;
    case 'h': line.wantsHelp = true; break;
    case 'I': line.isInteractive = true; break;
    case 'U': line.isKilling = true; break;
    case 'T': line.wantsTcl = true; break;
    case 'i': line.ini_path = option.value; break;
    default: break;  // R: the lock of the HAL segment is robust, it frees itself when its holder dies
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
    line.session.library = lang::default_library();
    return line;
}

Result<> IniOption::load(const std::string &path) {
    if (path.empty()) {
        return {};
    }
    Result<config::IniFile> file = config::IniFile::load(path, sink_);
    if (!file) {
        return std::unexpected(file.error());
    }
    if (sink_.count_errors() > 0) {
        return fail(fmt::format("INI file '{}' has errors", path));
    }
    file_ = std::make_unique<config::IniFile>(std::move(*file));
    lookup_ = std::make_unique<lang::IniFileLookup>(*file_);
    return {};
}

namespace {

/// Gives the lines of standard input: from an editor at a terminal, else as they come.
class InputLines {
  public:
    explicit InputLines(lang::Session &session) : isTerminal_(isatty(STDIN_FILENO) == 1) {
        if (isTerminal_) {
            LineEditorOptions options;
            options.history_file = history_file("halcmd");
            options.complete = [&session](const std::string &line) {
                return lang::completions(session, line);
            };
            options.stop = session.options().stop;
            editor_ = std::make_unique<LineEditor>(std::move(options));
        }
    }
    bool isTerminal() const { return isTerminal_; }
    /// The next line; `isContinued`: it goes on with the one before.
    std::optional<std::string> next(bool isContinued) {
        if (editor_ != nullptr) {
            return editor_->read(isContinued ? "      > " : "halcmd: ");
        }
        std::string line;
        return std::getline(std::cin, line) ? std::optional(line) : std::nullopt;
    }

  private:
    bool isTerminal_;
    std::unique_ptr<LineEditor> editor_;
};

}  // namespace

Result<> run_standard_input(lang::Session &session) {
    InputLines lines(session);
    Result<> first;
    std::string text;
    int number = 0;      // lines read
    int first_line = 1;  // of the command being read
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
