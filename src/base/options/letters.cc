// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/options/letters.hh"

#include <algorithm>

namespace mw::options {

Result<Letters> read_letters(const std::vector<std::string> &words, std::span<const KnownLetter> known,
                             EndOfLetters end) {
    Letters read;
    std::size_t i = 0;
    if (!words.empty() && words[0] == "--help") {
        read.options.push_back({'h', {}});
        ++i;
    }
    for (; i < words.size() && words[i] != "--"; ++i) {
        const std::string &word = words[i];
        if (word.size() < 2 || word[0] != '-') {
            if (end == EndOfLetters::FIRST_WORD) {
                break;
            }
            read.words.push_back(word);
            continue;
        }
        for (std::size_t k = 1; k < word.size(); ++k) {
            const char letter = word[k];
            const auto found = std::ranges::find(known, letter, &KnownLetter::letter);
            if (found == known.end()) {
                return fail(std::string("unknown option -") + letter);
            }
            if (found->value == nullptr) {
                read.options.push_back({letter, {}});
                continue;
            }
            const bool attached = k + 1 < word.size();
            if (!attached && i + 1 >= words.size()) {
                return fail(std::string("option -") + letter + " needs " + found->value);
            }
            read.options.push_back({letter, attached ? word.substr(k + 1) : words[i + 1]});
            i += attached ? 0 : 1;
            break;
        }
    }
    i += i < words.size() && words[i] == "--" ? 1 : 0;
    read.words.insert(read.words.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
    return read;
}

}  // namespace mw::options
