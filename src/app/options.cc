// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/options.hh"

#include "base/text.hh"

namespace mw::machine {

Result<Options> parse_options(const std::vector<std::string> &words, const OptionNames &names) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string &word = words[i];
        if (word.substr(0, 2) != "--") {
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
                        near.empty() ? "see millwright --help" : "did you mean " + near + "?");
        }
    }
    return options;
}

}  // namespace mw::machine
