// SPDX-License-Identifier: GPL-2.0-or-later
// Receiver of messages for a person: errors, warnings and notes, each with its position in a text.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::diagnostics {

enum class Severity { NOTE, WARNING, ERROR };

struct Diagnostic {
    Severity severity = Severity::ERROR;
    Error what;
    /// Callers of this position, innermost first (subroutine calls, sourced files).
    std::vector<SourcePlace> called_from{};
    /// The line of text at this position, for the caret; empty when there is none.
    std::string line_text{};

    /// Several lines: "file:line:col: error: message", the text with a caret, "  called from ...".
    std::string str() const;
    /// The part of str() after its first line, indented; empty when there is neither a line of text nor a
    /// caller.
    std::string context() const;
};

/// Collects diagnostics. Work continues after an error, so one run reports several.
class Sink {
  public:
    using Listener = std::function<void(const Diagnostic &)>;

    Sink() = default;
    explicit Sink(Listener listener) : listener_(std::move(listener)) {}

    void report(Diagnostic diagnostic);
    void error(std::string message, SourcePlace place = {}, std::string hint = {});
    void error(Error what) { report({Severity::ERROR, std::move(what)}); }
    /// Adds the failure of a Result, unless it has been reported already.
    void failure(const Error &what);
    void warning(std::string message, SourcePlace place = {}, std::string hint = {});
    void note(std::string message, SourcePlace place = {});

    bool hasErrors() const { return errors_ > 0; }
    int count_errors() const { return errors_; }
    const std::vector<Diagnostic> &all() const { return all_; }
    void clear();

  private:
    Listener listener_{};
    std::vector<Diagnostic> all_{};
    int errors_ = 0;
};

}  // namespace mw::diagnostics
