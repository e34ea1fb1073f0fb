// SPDX-License-Identifier: GPL-2.0-or-later
#include "diag/sink.hh"

namespace mw::diag {
namespace {

const char *name_of(Severity severity) {
    switch (severity) {
    case Severity::NOTE: return "note";
    case Severity::WARNING: return "warning";
    case Severity::ERROR: break;
    }
    return "error";
}

/// Blanks under the text up to the column, tabs kept so that the caret lines up.
std::string caret_line(const std::string &text, int column) {
    std::string out;
    for (int i = 0; i + 1 < column && i < static_cast<int>(text.size()); ++i) {
        out += text[static_cast<std::size_t>(i)] == '\t' ? '\t' : ' ';
    }
    return out + '^';
}

}  // namespace

std::string Diagnostic::str() const {
    std::string out = what.place.str();
    if (!out.empty()) {
        out += ": ";
    }
    out += std::string(name_of(severity)) + ": " + what.message;
    if (!what.hint.empty()) {
        out += " (" + what.hint + ')';
    }
    const std::string rest = context();
    return rest.empty() ? out : out + '\n' + rest;
}

std::string Diagnostic::context() const {
    std::string out;
    if (!line_text.empty()) {
        out += "\n  " + line_text;
        if (what.place.column > 0) {
            out += "\n  " + caret_line(line_text, what.place.column);
        }
    }
    for (const SourcePlace &caller : called_from) {
        out += "\n  called from " + caller.str();
    }
    return out.empty() ? out : out.substr(1);
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

}  // namespace mw::diag
