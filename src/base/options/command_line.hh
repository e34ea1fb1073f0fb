// SPDX-License-Identifier: GPL-2.0-or-later
// The command line of our programs: each option is declared once, for reading and --help. Programs whose
// options must match another program read them with base/options/letters.hh or by hand
// (docs/developer/decisions).
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::options {

using Words = std::vector<std::string>;

/// Names are long ("--plot"), short ("-o") or both ("-o,--output"). Values are "--name value" or
/// "--name=value". If an option occurs twice the last value counts, unless it is a list. Bound variables must
/// outlive the object.
class CommandLine {
  public:
    /// Texts of --help: "millwright run MACHINE.ini PROGRAM.ngc", and what the program does.
    CommandLine(std::string usage, std::string about);

    void flag(const std::string &names, const std::string &doc, bool &into, bool value = true);
    void text(const std::string &names, const std::string &what, const std::string &doc, std::string &into);
    /// An option that may occur several times.
    void texts(const std::string &names, const std::string &what, const std::string &doc, Words &into);
    /// An option with the value "on" or "off".
    void on_or_off(const std::string &names, const std::string &doc, bool &into);
    /// A number from `low` to `high`.
    void number(const std::string &names, const std::string &what, const std::string &doc, double &into,
                double low, double high);
    /// A whole number from `low` to `high`.
    template <std::integral T>
    void number(const std::string &names, const std::string &what, const std::string &doc, T &into,
                std::int64_t low, std::int64_t high) {
        take(names, 1, what, doc, [&into, low, high](const Words &words) -> Result<> {
            const auto number = whole_number(words[0], low, high);
            if (!number.has_value()) {
                return std::unexpected(number.error());
            }
            into = static_cast<T>(*number);
            return {};
        });
    }
    /// Each occurrence passes a number of words to `taker`. Without `doc` the option is not listed by --help.
    using Taker = std::function<Result<>(const Words &)>;
    void take(const std::string &names, int words, const std::string &what, const std::string &doc,
              Taker taker);
    /// Words that belong to no option.
    void rest(Words &into) { rest_ = &into; }
    /// As rest(), for texts with numbers: words with one dash (-5, -.5) belong to the text unless the program
    /// has an option of that letter.
    void rest_of_text(Words &into) {
        rest_ = &into;
        is_rest_text_ = true;
    }
    /// Text of --help after the options.
    void footer(std::string text) { footer_ = std::move(text); }

    /// An error names the option. For an unknown option it also names the most similar option.
    Result<> parse(const Words &words) const;
    std::string help() const;

  private:
    struct Option {
        std::string names;
        int words = 0;
        std::string what, doc;
        Taker take;
    };
    static Result<std::int64_t> whole_number(const std::string &text, std::int64_t low, std::int64_t high);
    static void hand_over(const Option &option, const Words &values);
    Words names() const;
    bool isForOptions(const std::string &word, const Words &known) const;
    Error unknown(const std::string &word) const;

    std::string usage_, about_, footer_;
    std::vector<Option> options_;
    Words *rest_ = nullptr;
    bool is_rest_text_ = false;
};

/// True if one of the words requests help.
bool wantsHelp(const Words &words);

}  // namespace mw::options
