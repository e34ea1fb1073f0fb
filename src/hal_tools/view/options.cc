// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal_tools/view/options.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::hal::view {

Result<std::vector<std::string>> parse_options(const std::vector<std::string> &words,
                                               const std::vector<Option> &options) {
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i].size() < 2 || words[i][0] != '-') {
            rest.push_back(words[i]);
            continue;
        }
        const std::size_t equals = words[i].find('=');
        const std::string name = words[i].substr(0, equals);
        const auto option =
            std::find_if(options.begin(), options.end(), [&](const Option &o) { return o.name == name; });
        if (option == options.end()) {
            std::vector<std::string> known;
            for (const Option &o : options) {
                known.push_back(o.name);
            }
            const std::string near = nearest_name(name, known);
            return fail(fmt::format("unknown option '{}'", name), {},
                        near.empty() ? "" : fmt::format("did you mean {}?", near));
        }
        std::vector<std::string> taken;
        if (equals != std::string::npos) {
            taken.push_back(words[i].substr(equals + 1));
        }
        while (static_cast<int>(taken.size()) < option->words && i + 1 < words.size()) {
            taken.push_back(words[++i]);
        }
        if (static_cast<int>(taken.size()) != option->words) {
            return fail(
                fmt::format("option {} takes {} word{}", name, option->words, option->words == 1 ? "" : "s"));
        }
        const Result<> done = option->take(taken);
        if (!done) {
            return std::unexpected(done.error());
        }
    }
    return rest;
}

Result<double> number_in(const std::string &text, double low, double high) {
    const auto number = parse_double(text);
    if (!number || !(*number >= low && *number <= high)) {
        return fail(fmt::format("'{}' is no number from {:g} to {:g}", text, low, high));
    }
    return *number;
}

}  // namespace mw::hal::view
