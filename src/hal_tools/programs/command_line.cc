// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/programs/command_line.hh"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "hal_lang/lang/completion.hh"
#include "hal_tools/programs/line_editor.hh"

namespace mw::hal::tools {

namespace {

/// Applies one option letter; false when there is none like it.
bool apply(CommandLine &line, char option) {
    lang::SessionOptions &session = line.session;
    switch (option) {
    case 'f': line.readsInput = true; return true;
    case 'k': session.keepsGoing = true; return true;
    case 'q': session.verbosity = lang::Verbosity::ERRORS; return true;
    case 'Q': session.verbosity = lang::Verbosity::SILENT; return true;
    case 's': session.isScript = true; return true;
    case 'v': session.verbosity = lang::Verbosity::RESULTS; return true;
    case 'V': session.verbosity = lang::Verbosity::EVERYTHING; return true;
    case 'e': session.isEchoing = true; return true;
    case 'h': line.wantsHelp = true; return true;
    case 'I': line.isInteractive = true; return true;
    case 'U': line.isKilling = true; return true;
    case 'T': line.wantsTcl = true; return true;
    case 'R':
        // The lock of the HAL segment is robust: it frees itself when its holder dies.
        return true;
    default: return false;
    }
}

}  // namespace

Result<CommandLine> parse_command_line(const std::vector<std::string> &arguments) {
    CommandLine line;
    std::size_t i = 0;
    for (; i < arguments.size(); ++i) {
        const std::string &word = arguments[i];
        if (word == "--") {
            ++i;
            break;
        }
        if (word.size() < 2 || word[0] != '-') {
            break;
        }
        for (std::size_t k = 1; k < word.size(); ++k) {
            if (word[k] == 'i') {
                // The file follows at once or as the next word.
                const bool isAttached = k + 1 < word.size();
                if (!isAttached && i + 1 >= arguments.size()) {
                    return fail("option -i needs the name of an INI file");
                }
                line.ini_path = isAttached ? word.substr(k + 1) : arguments[++i];
                break;
            }
            if (!apply(line, word[k])) {
                return fail(fmt::format("unknown option -{}", word[k]));
            }
        }
    }
    line.words.assign(arguments.begin() + static_cast<std::ptrdiff_t>(i), arguments.end());
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
