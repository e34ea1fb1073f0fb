// SPDX-License-Identifier: GPL-2.0-or-later
// Options of the commands here: a table of names, each with how many words it takes and what they do.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::hal::view {

struct Option {
    std::string name;
    int words = 0;  ///< that follow it
    std::function<Result<>(const std::vector<std::string> &)> take;
};

/// Calls take() for each option found and returns the other words. "--name=word" is "--name word".
Result<std::vector<std::string>> parse_options(const std::vector<std::string> &words,
                                               const std::vector<Option> &options);

/// A number in [low, high] of an option.
Result<double> number_in(const std::string &text, double low, double high);

}  // namespace mw::hal::view
