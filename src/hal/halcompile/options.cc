// SPDX-License-Identifier: GPL-2.0-or-later
#include <array>

#include <fmt/core.h>

#include "base/text.hh"
#include "hal/halcompile/program.hh"
#include "hal/halcompile/toolchain.hh"

namespace mw::halcompile {
namespace {

enum class What { MODE, USERSPACE, REQUIRE_LICENSE, PERSONALITIES, OUTPUT, COMPILE_ARGS, LINK_ARGS };
struct Known {
    std::string_view name;
    char letter;
    bool takesValue;
    What what;
    Mode mode = Mode::PREPROCESS;
};
constexpr std::array<Known, 16> OPTIONS{{{"preprocess", 'p', false, What::MODE, Mode::PREPROCESS},
                                         {"compile", 'c', false, What::MODE, Mode::COMPILE},
                                         {"install", 'i', false, What::MODE, Mode::INSTALL},
                                         {"document", 'd', false, What::MODE, Mode::DOCUMENT},
                                         {"install-doc", 'j', false, What::MODE, Mode::INSTALL_DOC},
                                         {"view-doc", 'v', false, What::MODE, Mode::VIEW_DOC},
                                         {"print-modinc", '\0', false, What::MODE, Mode::PRINT_MODINC},
                                         {"help", 'h', false, What::MODE, Mode::HELP},
                                         {"userspace", 'u', false, What::USERSPACE},
                                         {"require-license", 'l', false, What::REQUIRE_LICENSE},
                                         {"personalities", 'P', true, What::PERSONALITIES},
                                         {"personality", '\0', true, What::PERSONALITIES},
                                         {"outfile", 'o', true, What::OUTPUT},
                                         {"output", '\0', true, What::OUTPUT},
                                         {"extra-compile-args", '\0', true, What::COMPILE_ARGS},
                                         {"extra-link-args", '\0', true, What::LINK_ARGS}}};

Result<const Known *> find_long(std::string_view word) {
    const Known *found = nullptr;
    for (const Known &known : OPTIONS) {
        if (known.name == word) {
            return &known;
        }
        if (known.name.starts_with(word)) {
            if (found != nullptr) {
                return fail(fmt::format("--{} is ambiguous: --{} or --{}", word, found->name, known.name));
            }
            found = &known;
        }
    }
    if (found == nullptr) {
        std::vector<std::string> names;
        for (const Known &known : OPTIONS) {
            names.emplace_back(known.name);
        }
        const std::string near = nearest_name(word, names);
        return fail(fmt::format("unknown option --{}", word), {},
                    near.empty() ? "--help lists them" : fmt::format("did you mean --{}?", near));
    }
    return found;
}

Result<> add_words(std::vector<std::string> &to, const std::string &text) {
    auto words = split_shell_words(text);
    if (!words) {
        return std::unexpected(words.error());
    }
    to.insert(to.end(), words->begin(), words->end());
    return {};
}

Result<> apply(const Known &known, const std::string &value, Options &options) {
    switch (known.what) {
    case What::MODE: options.mode = known.mode; return {};
    case What::USERSPACE: options.userspace = true; return {};
    case What::REQUIRE_LICENSE: options.requiresLicense = true; return {};
    case What::OUTPUT: options.output = value; return {};
    case What::COMPILE_ARGS: return add_words(options.compile_args, value);
    case What::LINK_ARGS: return add_words(options.link_args, value);
    case What::PERSONALITIES: {
        const auto number = parse_int(value);
        if (!number || *number < 1 || *number > 65536) {
            return fail(fmt::format("--personalities={} must be a number from 1 to 65536", value));
        }
        options.personalities = static_cast<int>(*number);
        return {};
    }
    }
    return {};
}

}  // namespace

Result<Options> parse_options(const std::vector<std::string> &arguments) {
    Options options;
    bool all_files = false;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string &word = arguments[i];
        if (all_files || word.size() < 2 || word[0] != '-') {
            options.files.push_back(word);
            continue;
        }
        if (word == "--") {
            all_files = true;
            continue;
        }
        const bool is_long = word[1] == '-';
        const std::size_t equals = is_long ? word.find('=') : std::string::npos;
        std::vector<const Known *> found;
        if (is_long) {
            const auto one = find_long(
                std::string_view(word).substr(2, equals == std::string::npos ? equals : equals - 2));
            if (!one) {
                return std::unexpected(one.error());
            }
            found.push_back(*one);
        } else {
            for (const char letter : std::string_view(word).substr(1)) {
                const Known *one = nullptr;
                for (const Known &known : OPTIONS) {
                    one = known.letter == letter ? &known : one;
                }
                if (one == nullptr) {
                    return fail(fmt::format("unknown option -{}", letter), {}, "--help lists them");
                }
                found.push_back(one);
            }
        }
        for (const Known *known : found) {
            std::string value;
            if (known->takesValue && equals != std::string::npos) {
                value = word.substr(equals + 1);
            } else if (known->takesValue && ++i < arguments.size()) {
                value = arguments[i];
            } else if (known->takesValue) {
                return fail(fmt::format("--{} needs a value", known->name));
            }
            if (auto done = apply(*known, value, options); !done) {
                return std::unexpected(done.error());
            }
        }
    }
    return options;
}

}  // namespace mw::halcompile
