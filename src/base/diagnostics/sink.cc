// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/diagnostics/sink.hh"

#include <algorithm>

#include "base/short_text.hh"
#include "base/text.hh"

namespace mw::diagnostics {
namespace {

const char *name_of(Severity severity) {
    switch (severity) {
    case Severity::NOTE: return "note";
    case Severity::WARNING: return "warning";
    case Severity::ERROR: break;
    }
    return "error";
}

/// A continuation byte of UTF-8.
bool isContinuation(char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

/// Blanks under the text up to the column, tabs kept so that the caret lines up.
std::string caret_line(const std::string &text, int column) {
    std::string out;
    for (int i = 0; i + 1 < column && i < static_cast<int>(text.size()); ++i) {
        const char c = text[static_cast<std::size_t>(i)];
        out += isContinuation(c) ? "" : (c == '\t' ? "\t" : " ");
    }
    return out + '^';
}

/// The part of a line around a column that fits on a screen, and the column in that part.
std::string shortened(const std::string &line, int &column) {
    constexpr std::size_t LONGEST = 200, BEFORE = 100;
    constexpr const char *MORE = "...";
    if (line.size() <= LONGEST) {
        return line;
    }
    const std::size_t at = static_cast<std::size_t>(column > 0 ? column - 1 : 0);
    std::size_t first = at > BEFORE ? std::min(at - BEFORE, line.size()) : 0;
    std::size_t last = std::min(first + LONGEST, line.size());
    while (first < at && isContinuation(line[first])) {
        ++first;
    }
    while (last > first && last < line.size() && isContinuation(line[last])) {
        --last;
    }
    const std::string before = first > 0 ? MORE : "";
    const std::string after = last < line.size() ? MORE : "";
    column = column > 0 ? static_cast<int>(at - first + before.size()) + 1 : 0;
    return before + line.substr(first, last - first) + after;
}

/// One line for each caller; repeated callers share one line.
std::string callers_text(const std::vector<SourcePlace> &callers) {
    std::string out;
    for (std::size_t i = 0; i < callers.size();) {
        std::size_t end = i + 1;
        while (end < callers.size() && callers[end].str() == callers[i].str()) {
            ++end;
        }
        out += "\n  called from " + callers[i].str();
        out += end - i > 1 ? ", " + std::to_string(end - i) + " times" : "";
        i = end;
    }
    return out;
}

}  // namespace

std::string Diagnostic::str() const {
    std::string out = what.place.str();
    if (!out.empty()) {
        out += ": ";
    }
    out += std::string(name_of(severity)) + ": " + short_text(what.message);
    if (!what.hint.empty()) {
        out += " (" + short_text(what.hint) + ')';
    }
    const std::string rest = context();
    return printable(rest.empty() ? out : out + '\n' + rest);
}

std::string Diagnostic::context() const {
    std::string out;
    if (!line_text.empty()) {
        int column = what.place.column;
        const std::string text = shortened(line_text, column);
        out += "\n  " + text;
        if (column > 0) {
            out += "\n  " + caret_line(text, column);
        }
    }
    out += callers_text(called_from);
    return out.empty() ? out : printable(out.substr(1));
}

void Sink::report(Diagnostic diagnostic) {
    if (diagnostic.severity == Severity::ERROR) {
        ++errors_;
    }
    all_.push_back(std::move(diagnostic));
    if (listener_) {
        listener_(all_.back());
    }
}

void Sink::error(std::string message, SourcePlace place, std::string hint) {
    report({Severity::ERROR, {std::move(message), std::move(place), std::move(hint)}});
}

void Sink::failure(const Error &what) {
    if (!what.isTold) {
        error(what);
    }
}

void Sink::warning(std::string message, SourcePlace place, std::string hint) {
    report({Severity::WARNING, {std::move(message), std::move(place), std::move(hint)}});
}

void Sink::note(std::string message, SourcePlace place) {
    report({Severity::NOTE, {std::move(message), std::move(place), {}}});
}

void Sink::clear() {
    all_.clear();
    errors_ = 0;
}

}  // namespace mw::diagnostics
