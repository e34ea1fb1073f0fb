// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/options.hh"

#include <algorithm>

#include "base/text.hh"

namespace mw::app {

Result<Options> parse_options(const std::vector<std::string> &words, const OptionNames &names) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string &word = words[i];
        if (word.empty() || word[0] != '-') {
            options.rest.push_back(word);
            continue;
        }
        const auto equals = word.find('=');
        const std::string name = word.substr(0, equals);
        if (names.flags.count(name) > 0 && equals == std::string::npos) {
            options.flags.insert(name);
        } else if (names.values.count(name) > 0 && equals != std::string::npos) {
            options.values[name] = word.substr(equals + 1);
        } else if (names.values.count(name) > 0 && i + 1 < words.size()) {
            options.values[name] = words[++i];
        } else if (names.values.count(name) > 0) {
            return fail("option " + name + " needs a value");
        } else {
            std::vector<std::string> known(names.flags.begin(), names.flags.end());
            known.insert(known.end(), names.values.begin(), names.values.end());
            const std::string near = nearest_name(name, known);
            return fail("unknown option " + word, {},
                        near.empty() ? "see --help" : "did you mean " + near + "?");
        }
    }
    return options;
}

Result<bool> Options::on_or_off(const std::string &name, bool preset) const {
    const std::string text = value(name, preset ? "on" : "off");
    if (text != "on" && text != "off") {
        return fail(name + " is on or off, not '" + text + "'");
    }
    return text == "on";
}

bool wantsHelp(const std::vector<std::string> &words) {
    return std::ranges::any_of(words, [](const auto &word) { return word == "--help" || word == "-h"; });
}

}  // namespace mw::app
