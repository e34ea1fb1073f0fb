// SPDX-License-Identifier: GPL-2.0-or-later
// The common part of the two stream programs: parsing arguments, joining the instance, ending on signals,
// reporting.
#pragma once

#include <csignal>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/language/language.hh"
#include "base/options/letters.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "hal/core/instance.hh"

namespace mw::programs {

/// Runs `work` attached to the user's instance; returns the exit status.
inline int run_attached(const char *program,
                        const std::function<Result<>(volatile std::sig_atomic_t &)> &work) {
    catch_stop_signals();
    const auto instance = hal::Instance::attach(hal::default_instance());
    Result<> result;
    if (instance) {
        hal::set_process_instance(instance->get());
        result = work(stop_signal);
        hal::set_process_instance(nullptr);
    } else {
        result = std::unexpected(instance.error());
    }
    if (!result) {
        language::tell(program, result.error());
    }
    return result ? 0 : 1;
}

struct StreamWords {
    std::optional<std::vector<std::string>> words;  ///< nothing: the program ends with `status`
    int status = 1;
};

/// Calls `take` for each option with its number, 0 if it has none. Wrong usage is reported, with status 1.
inline StreamWords read_stream_words(const char *program, const std::vector<std::string> &words,
                                     std::span<const options::KnownLetter> known, const char *usage,
                                     const std::function<void(char letter, long number)> &take) {
    auto read = options::read_letters(words, known, options::EndOfLetters::ALL_WORDS);
    if (!read) {
        language::tell(program, read.error());
        std::fputs(language::shown(usage).c_str(), stderr);
        return {};
    }
    for (const options::Letter &option : read->options) {
        if (option.letter == 'h') {
            std::fputs(language::shown(usage).c_str(), stdout);
            return {std::nullopt, 0};
        }
        const auto number = option.value.empty() ? std::int64_t{0} : parse_int(option.value).value_or(-1);
        if (number < 0) {
            language::tell(program, Error{"'" + option.value + "' is not a number of 0 or more", {}, {}});
            return {};
        }
        take(option.letter, static_cast<long>(number));
    }
    return {std::move(read->words), 0};
}

}  // namespace mw::programs
