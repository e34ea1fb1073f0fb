// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/programs/line_editor.hh"

#include <histedit.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "hal/script/completion.hh"

namespace mw::hal::tools {

namespace {

constexpr int HISTORY_LINES = 1000;
constexpr std::size_t SCREEN_WIDTH = 80;

/// Words in columns, as many as fit.
void print_columns(const std::vector<std::string> &words) {
    std::size_t width = 0;
    for (const std::string &word : words) {
        width = std::max(width, word.size() + 2);
    }
    const std::size_t columns = std::max<std::size_t>(1, SCREEN_WIDTH / width);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool endsLine = (i + 1) % columns == 0 || i + 1 == words.size();
        std::printf("%-*s%s", endsLine ? 0 : static_cast<int>(width), words[i].c_str(), endsLine ? "\n" : "");
    }
}

}  // namespace

struct LineEditor::Impl {
    LineEditorOptions options;
    EditLine *editor = nullptr;
    History *history = nullptr;
    std::string prompt;

    static Impl &of(EditLine *editor) {
        void *data = nullptr;
        el_get(editor, EL_CLIENTDATA, &data);
        return *static_cast<Impl *>(data);
    }

    static char *get_prompt(EditLine *editor) { return of(editor).prompt.data(); }

    bool isStopped() const { return options.stop != nullptr && *options.stop != 0; }

    /// Reads one byte as one character, because HAL names are ASCII.
    static int get_character(EditLine *editor, wchar_t *character) {
        const Impl &here = of(editor);
        while (!here.isStopped()) {
            pollfd input{STDIN_FILENO, POLLIN, 0};
            const int ready = ::poll(&input, 1, -1);
            if (ready < 0 && errno == EINTR) {
                continue;
            }
            unsigned char byte = 0;
            if (ready <= 0 || ::read(STDIN_FILENO, &byte, 1) != 1) {
                return 0;
            }
            // If the user types end-of-input before the editor has set up the terminal, Linux passes a 0
            // (n_tty).
            constexpr unsigned char END_OF_INPUT = 4;
            *character = byte == 0 ? END_OF_INPUT : byte;
            return 1;
        }
        return 0;
    }

    static unsigned char complete(EditLine *editor, int) {
        const Impl &here = of(editor);
        const LineInfo *info = el_line(editor);
        const std::string line(info->buffer, info->cursor);
        const std::vector<std::string> words = here.options.complete(line);
        if (words.empty()) {
            return CC_REFRESH_BEEP;
        }
        const std::size_t blank = line.find_last_of(" \t");
        const std::size_t typed = blank == std::string::npos ? line.size() : line.size() - blank - 1;
        const std::string common = script::common_beginning(words);
        std::string rest = common.substr(std::min(typed, common.size()));
        const bool whole = words.size() == 1 && !common.ends_with('/') && !common.ends_with('=');
        rest += whole ? " " : "";
        if (!rest.empty()) {
            return el_insertstr(editor, rest.c_str()) == 0 ? CC_REFRESH : CC_REFRESH_BEEP;
        }
        std::fputc('\n', stdout);
        print_columns(words);
        std::fflush(stdout);
        return CC_REDISPLAY;
    }
};

LineEditor::LineEditor(LineEditorOptions options) : impl_(std::make_unique<Impl>()) {
    Impl &here = *impl_;
    here.options = std::move(options);
    here.editor = el_init("halcmd", stdin, stdout, stderr);
    here.history = history_init();
    HistEvent event{};
    ::history(here.history, &event, H_SETSIZE, HISTORY_LINES);
    ::history(here.history, &event, H_SETUNIQUE, 1);
    if (!here.options.history_file.empty()) {
        ::history(here.history, &event, H_LOAD, here.options.history_file.c_str());
    }
    el_set(here.editor, EL_CLIENTDATA, &here);
    el_set(here.editor, EL_PROMPT, Impl::get_prompt);
    el_set(here.editor, EL_EDITOR, "emacs");
    el_set(here.editor, EL_HIST, ::history, here.history);
    el_set(here.editor, EL_SIGNAL, 1);
    el_set(here.editor, EL_GETCFN, Impl::get_character);
    el_set(here.editor, EL_ADDFN, "hal-complete", "Complete names of HAL", Impl::complete);
    el_set(here.editor, EL_BIND, "^I", "hal-complete", nullptr);
    el_set(here.editor, EL_BIND, "^R", "em-inc-search-prev", nullptr);
    // The user's own bindings.
    el_source(here.editor, nullptr);
}

LineEditor::~LineEditor() {
    Impl &here = *impl_;
    if (!here.options.history_file.empty()) {
        std::error_code ignored;
        std::filesystem::create_directories(std::filesystem::path(here.options.history_file).parent_path(),
                                            ignored);
        HistEvent event{};
        ::history(here.history, &event, H_SAVE, here.options.history_file.c_str());
    }
    el_end(here.editor);
    history_end(here.history);
}

std::optional<std::string> LineEditor::read(const std::string &prompt) {
    Impl &here = *impl_;
    here.prompt = prompt;
    int length = 0;
    const char *text = el_gets(here.editor, &length);
    if (text == nullptr || length <= 0 || here.isStopped()) {
        return std::nullopt;
    }
    std::string line(text, static_cast<std::size_t>(length));
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) {
        line.pop_back();
    }
    if (line.find_first_not_of(" \t") != std::string::npos) {
        HistEvent event{};
        ::history(here.history, &event, H_ENTER, line.c_str());
    }
    return line;
}

std::string history_file(const std::string &name) {
    const char *state = std::getenv("XDG_STATE_HOME");
    const char *home = std::getenv("HOME");
    if (state != nullptr && state[0] == '/') {
        return std::string(state) + "/millwright/" + name + "_history";
    }
    return home == nullptr ? "" : std::string(home) + "/.local/state/millwright/" + name + "_history";
}

}  // namespace mw::hal::tools
