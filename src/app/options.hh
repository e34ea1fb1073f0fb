// SPDX-License-Identifier: GPL-2.0-or-later
// Words of a command line: flags, options with a value, and the rest.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::machine {

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
};

/// "--name value" and "--name=value". An unknown option is an error that names the known ones.
Result<Options> parse_options(const std::vector<std::string> &words, const OptionNames &names);

}  // namespace mw::machine
