// SPDX-License-Identifier: GPL-2.0-or-later
// Lines typed at a terminal, with editing, history and completion.
#pragma once

#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace mw::hal::tools {

struct LineEditorOptions {
    std::string history_file;  ///< kept over sessions; empty: none
    /// Returns possible words at the end of the line.
    std::function<std::vector<std::string>(const std::string &line)> complete;
    const volatile std::sig_atomic_t *stop = nullptr;  ///< not zero: input ends
};

/// Uses libedit; ^C discards the line, unless `stop` is used. [one thread]
class LineEditor {
  public:
    explicit LineEditor(LineEditorOptions options);
    /// Writes the history.
    ~LineEditor();
    LineEditor(const LineEditor &) = delete;
    LineEditor &operator=(const LineEditor &) = delete;

    /// The next line without its end; nothing at the end of input.
    std::optional<std::string> read(const std::string &prompt);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Path of a program's history: $XDG_STATE_HOME/millwright/NAME_history, or below ~/.local/state.
std::string history_file(const std::string &name);

}  // namespace mw::hal::tools
