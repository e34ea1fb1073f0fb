// SPDX-License-Identifier: GPL-2.0-or-later
// Functions that the commands of `millwright` share at their start.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/diagnostics/sink.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"

namespace mw::programs {

/// Reads the arguments into `words`, which has `line()` and `parse()`. Returns the exit status if the command
/// ends there: 0 after --help, 2 after a message about wrong usage.
template <class Words>
std::optional<int> ended_by_words(std::string_view command, Words &words,
                                  const std::vector<std::string> &arguments) {
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    if (const auto parsed = words.parse(arguments); !parsed.has_value()) {
        fmt::print(stderr, "millwright {}: {}\n", command, language::shown(parsed.error().str()));
        return 2;
    }
    return std::nullopt;
}

/// Writes messages to standard error, in the language of the person.
inline diagnostics::Sink standard_error_sink() {
    return diagnostics::Sink(
        [](const diagnostics::Diagnostic &d) { fmt::print(stderr, "{}\n", language::shown(d.str())); });
}

}  // namespace mw::programs
