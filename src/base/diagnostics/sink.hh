// SPDX-License-Identifier: GPL-2.0-or-later
// Where messages for a person go: errors, warnings and notes, each with its place.
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
    /// Innermost caller first: where the place was reached from (subroutine calls, sourced files).
    std::vector<SourcePlace> called_from{};
    /// The line of text that the place is in, for the caret; empty when there is none.
    std::string line_text{};

    /// Several lines: "file:line:col: error: message", the text with a caret, "  called from ...".
    std::string str() const;
    /// The part of str() after its first line, indented; empty when there is neither text nor caller.
    std::string context() const;
};

/// Collects diagnostics; work goes on after an error so that several are reported in one run.
class Sink {
  public:
    using Listener = std::function<void(const Diagnostic &)>;

    Sink() = default;
    explicit Sink(Listener listener) : listener_(std::move(listener)) {}

    void report(Diagnostic diagnostic);
    void error(std::string message, SourcePlace place = {}, std::string hint = {});
    void error(Error what) { report({Severity::ERROR, std::move(what)}); }
    /// The failure of a Result: nothing when it has been told already.
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
