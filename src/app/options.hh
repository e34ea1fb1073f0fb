// SPDX-License-Identifier: GPL-2.0-or-later
// Words of a command line: flags, options with a value, and the rest.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::app {

struct OptionNames {
    std::set<std::string> flags;
    std::set<std::string> values;
};

struct Options {
    std::set<std::string> flags;
    std::map<std::string, std::string> values;
    std::vector<std::string> rest;

    bool has(const std::string &flag) const { return flags.count(flag) > 0; }
    std::string value(const std::string &name, const std::string &preset = "") const {
        const auto found = values.find(name);
        return found == values.end() ? preset : found->second;
    }
    /// "on" or "off"; anything else is an error that names the option.
    Result<bool> on_or_off(const std::string &name, bool preset) const;
};

/// "--name value" and "--name=value". An unknown option is an error that names the nearest one.
Result<Options> parse_options(const std::vector<std::string> &words, const OptionNames &names);

/// One of the words asks for help.
bool wantsHelp(const std::vector<std::string> &words);

}  // namespace mw::app
