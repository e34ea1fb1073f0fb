// SPDX-License-Identifier: GPL-2.0-or-later
// The fields and options of lines in an NML configuration: one row for each.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/config/settings.hh"

namespace mw::nml {

struct Word {
    std::string_view text;
    SourcePlace place;
};

/// A field has a fixed position in the line; its words are stored in the line's settings.
template <class Line>
struct LineField {
    const char *name;
    Result<> (*read)(std::string_view word, Line &line);
};

/// An option follows the fields, in any order: NAME or NAME=VALUE.
template <class Line>
struct LineOption {
    enum class Value { NONE, NEEDED, ALLOWED };
    const char *name;
    Value value;
    Result<> (*read)(std::string_view value, Line &line);
};

template <class Line>
struct LineForm {
    const char *letter;
    std::span<const LineField<Line>> fields;
    std::span<const LineOption<Line>> options;

    std::string usage() const {
        std::string text = letter;
        for (const LineField<Line> &field : fields) {
            text += fmt::format(" {}", field.name);
        }
        return text + (options.empty() ? "" : " [options]");
    }
};

const LineForm<BufferSettings> &buffer_form();
const LineForm<ProcessSettings> &process_form();

/// False if its value is wrong, which has been reported. An unknown option is a warning with the most similar
/// name.
bool read_option(const Word &word, const LineForm<BufferSettings> &form, BufferSettings &buffer,
                 diagnostics::Sink &sink);
/// Process lines have no options.
bool read_option(const Word &word, const LineForm<ProcessSettings> &form, ProcessSettings &process,
                 diagnostics::Sink &sink);

}  // namespace mw::nml
