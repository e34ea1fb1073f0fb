// SPDX-License-Identifier: GPL-2.0-or-later
// The only file that includes CLI11, a large header.
#include "base/options/command_line.hh"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/language/language.hh"
#include "base/text.hh"

namespace mw::options {
namespace {

constexpr std::size_t COLUMN = 24, WIDTH = 100;

/// "--plot" of "-o,--plot": the name for messages.
std::string spoken(const std::string &names) {
    return names.substr(names.rfind(',') + 1);
}

/// Breaks text into lines of at most WIDTH; later lines are indented to the text column.
std::string wrapped(const std::string &text) {
    std::string out;
    std::size_t used = COLUMN;
    for (const std::string &word : split_words(text)) {
        if (used > COLUMN && used + 1 + word.size() > WIDTH) {
            out += '\n' + std::string(COLUMN, ' ');
            used = COLUMN;
        }
        out += (used > COLUMN ? " " : "") + word;
        used += word.size() + (used > COLUMN ? 1 : 0);
    }
    return out;
}

/// Prefix of words that CLI11 must not interpret: it removes brackets, and takes -.5 for an option.
constexpr char PLAIN = '\1';

std::string without_mark(const std::string &word) {
    return word.starts_with(PLAIN) ? word.substr(1) : word;
}

/// An exception that carries an error through CLI11.
struct Refused {
    Error error;
};

/// CLI11's error in our words.
Error number_of_words(const std::string &names, int words) {
    if (words > 1) {
        return {"option " + spoken(names) + " takes " + std::to_string(words) + " arguments"};
    }
    return {words == 0 ? "option " + spoken(names) + " takes no value"
                       : "option " + spoken(names) + " needs a value"};
}

}  // namespace

CommandLine::CommandLine(std::string usage, std::string about)
    : usage_(std::move(usage)), about_(std::move(about)) {}

void CommandLine::take(const std::string &names, int words, const std::string &what, const std::string &doc,
                       Taker taker) {
    options_.push_back({names, words, what, doc, std::move(taker)});
}

void CommandLine::flag(const std::string &names, const std::string &doc, bool &into, bool value) {
    take(names, 0, "", doc, [&into, value](const Words &) -> Result<> {
        into = value;
        return {};
    });
}

void CommandLine::text(const std::string &names, const std::string &what, const std::string &doc,
                       std::string &into) {
    take(names, 1, what, doc, [&into](const Words &words) -> Result<> {
        into = words[0];
        return {};
    });
}

void CommandLine::texts(const std::string &names, const std::string &what, const std::string &doc,
                        Words &into) {
    take(names, 1, what, doc, [&into](const Words &words) -> Result<> {
        into.push_back(words[0]);
        return {};
    });
}

void CommandLine::on_or_off(const std::string &names, const std::string &doc, bool &into) {
    take(names, 1, "on|off", doc, [&into](const Words &words) -> Result<> {
        if (words[0] != "on" && words[0] != "off") {
            return fail("use on or off, not '" + words[0] + "'");
        }
        into = words[0] == "on";
        return {};
    });
}

void CommandLine::number(const std::string &names, const std::string &what, const std::string &doc,
                         double &into, double low, double high) {
    take(names, 1, what, doc, [&into, low, high](const Words &words) -> Result<> {
        const auto number = parse_double(words[0]);
        if (!number.has_value() || !(*number >= low && *number <= high)) {
            return fail("'" + words[0] + "' is not a number from " + to_text(low) + " to " + to_text(high));
        }
        into = *number;
        return {};
    });
}

Result<std::int64_t> CommandLine::whole_number(const std::string &text, std::int64_t low, std::int64_t high) {
    const auto number = parse_int(text);
    if (!number.has_value() || *number < low || *number > high) {
        return fail("'" + text + "' is not a whole number from " + std::to_string(low) + " to " +
                    std::to_string(high));
    }
    return *number;
}

/// Passes the words of all occurrences of the option.
void CommandLine::hand_over(const Option &option, const Words &values) {
    const std::size_t step = option.words == 0 ? 1 : static_cast<std::size_t>(option.words);
    if (values.size() % step != 0) {
        throw Refused{number_of_words(option.names, option.words)};
    }
    for (std::size_t i = 0; i < values.size(); i += step) {
        Words taken;
        for (std::size_t k = i; k < i + static_cast<std::size_t>(option.words); ++k) {
            taken.push_back(without_mark(values[k]));
        }
        auto done = option.take(taken);
        if (!done.has_value()) {
            done.error().message = "option " + spoken(option.names) + ": " + done.error().message;
            throw Refused{done.error()};
        }
    }
}

Words CommandLine::names() const {
    Words known;
    for (const Option &option : options_) {
        for (std::size_t at = 0; at != std::string::npos;) {
            const std::size_t end = option.names.find(',', at);
            known.push_back(option.names.substr(at, end == std::string::npos ? end : end - at));
            at = end == std::string::npos ? end : end + 1;
        }
    }
    return known;
}

/// True if CLI11 should look for an option in the word.
bool CommandLine::isForOptions(const std::string &word, const Words &known) const {
    const bool is_one_dash = word.size() > 1 && word[0] == '-' && word[1] != '-';
    return word.starts_with('-') &&
           (!is_one_dash || !is_rest_text_ || std::ranges::find(known, word.substr(0, 2)) != known.end());
}

Error CommandLine::unknown(const std::string &word) const {
    const std::string name = word.substr(0, word.find('='));
    const std::string near = nearest_name(name, names());
    return {"unknown option " + name, {}, near.empty() ? "see --help" : "did you mean " + near + "?"};
}

Result<> CommandLine::parse(const Words &words) const {
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();  // this class reports unknown words with its own message
    Words rest;
    for (const Option &option : options_) {
        const auto taken = [&option](const Words &values) { hand_over(option, values); };
        if (option.words == 0) {
            app.add_flag_function(option.names, [taken](std::int64_t) { taken({""}); })
                ->disable_flag_override();
        } else {
            app.add_option_function<Words>(option.names, taken)
                ->type_size(1)
                ->expected(option.words)
                ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
                ->allow_extra_args(false);
        }
    }
    app.add_option("words", rest);
    const Words known = names();
    Words backwards(words.rbegin(), words.rend());
    for (std::string &word : backwards) {
        word.insert(0, isForOptions(word, known) ? 0 : 1, PLAIN);
    }
    try {
        app.parse(backwards);
    } catch (const Refused &refused) {
        return std::unexpected(refused.error);
    } catch (const CLI::ParseError &error) {
        const std::string what = error.what();
        const std::string name = what.substr(0, what.find_first_of(": "));  // with or without its dashes
        for (const Option &option : options_) {
            if (option.names == name || spoken(option.names) == name || spoken(option.names) == "--" + name) {
                return std::unexpected(number_of_words(option.names, option.words));
            }
        }
        return fail(what);
    }
    for (const std::string &word : app.remaining()) {
        if (word != "--") {  // end of the options
            return std::unexpected(unknown(word));
        }
    }
    std::ranges::transform(rest, rest.begin(), without_mark);
    if (rest_ == nullptr && !rest.empty()) {
        return fail("unexpected argument '" + rest[0] + "'");
    }
    if (rest_ != nullptr) {
        *rest_ = std::move(rest);
    }
    return {};
}

std::string CommandLine::help() const {
    std::string out = language::shown("usage:") + ' ' + usage_ + "\n\n" + language::shown(about_);
    out += options_.empty() ? "" : "\n";
    for (const Option &option : options_) {
        if (option.doc.empty()) {
            continue;
        }
        std::string head = "  " + option.names + (option.what.empty() ? "" : ' ' + option.what);
        head += head.size() + 2 > COLUMN ? '\n' + std::string(COLUMN, ' ')
                                         : std::string(COLUMN - head.size(), ' ');
        out += head + wrapped(language::shown(option.doc)) + '\n';
    }
    return out + (footer_.empty() ? "" : '\n' + language::shown(footer_));
}

bool wantsHelp(const Words &words) {
    for (const std::string &word : words) {
        if (word == "--help" || word == "-h") {
            return true;
        }
    }
    return false;
}

}  // namespace mw::options
