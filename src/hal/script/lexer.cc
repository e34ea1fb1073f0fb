// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/lexer.hh"

#include <cstdlib>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::hal::script {

namespace {

constexpr std::string_view BLANKS = " \t\r\f\v";

bool isBlank(char c) {
    return BLANKS.find(c) != std::string_view::npos;
}

/// Index of the '#' that starts a comment (outside quotes), or the size.
std::size_t comment_start(const std::string &text) {
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != 0) {
            if (c == quote) {
                quote = 0;
            }
        } else if (c == '"' || c == '\'') {
            // An unclosed quote does not hide a comment; the word splitter reports it.
            if (text.find(c, i + 1) != std::string::npos) {
                quote = c;
            }
        } else if (c == '#') {
            return i;
        }
    }
    return text.size();
}

SourcePlace place_of(const PlacedText &text, std::size_t i, const std::string &file) {
    const PlacedText::Position p = text.at(i);
    return SourcePlace{file, p.line, p.column};
}

std::optional<std::string> process_environment(const std::string &name) {
    const char *value = std::getenv(name.c_str());
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

/// Finds variable names after '$' or ']' and replaces them.
class Substituter {
  public:
    Substituter(const PlacedText &line, const std::string &file, const Variables &variables)
        : line_(line), text_(line.text()), file_(file), variables_(variables) {}

    Result<PlacedText> run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            Result<> done;
            if (c == '$') {
                done = environment();
            } else if (c == '[') {
                done = ini();
            } else {
                out_.append(c, line_.at(at_));
                ++at_;
            }
            if (!done) {
                return std::unexpected(done.error());
            }
        }
        return std::move(out_);
    }

  private:
    /// Reads "(NAME)" or "NAME" up to a blank or the closing quote; `at_` is after it on return.
    Result<std::string> read_name(std::size_t start) {
        if (at_ < text_.size() && text_[at_] == '(') {
            const std::size_t close = text_.find(')', at_);
            if (close == std::string::npos) {
                return fail("missing ')' after a variable name", place_of(line_, at_, file_));
            }
            std::string name = text_.substr(at_ + 1, close - at_ - 1);
            at_ = close + 1;
            return checked(std::move(name), start);
        }
        std::size_t end = at_;
        while (end < text_.size() && !isBlank(text_[end]) && text_[end] != '"' && text_[end] != '\'') {
            ++end;
        }
        std::string name = text_.substr(at_, end - at_);
        at_ = end;
        return checked(std::move(name), start);
    }

    Result<std::string> checked(std::string name, std::size_t start) const {
        if (name.empty()) {
            return fail("empty variable name", place_of(line_, start, file_));
        }
        return name;
    }

    Result<> environment() {
        const std::size_t start = at_;
        ++at_;
        const Result<std::string> name = read_name(start);
        if (!name) {
            return std::unexpected(name.error());
        }
        const auto lookup = variables_.environment != nullptr ? variables_.environment : process_environment;
        const std::optional<std::string> value = lookup(*name);
        if (!value) {
            return fail(fmt::format("environment variable '{}' is not set", *name),
                        place_of(line_, start, file_));
        }
        out_.append(*value, line_.at(start));
        return {};
    }

    Result<> ini() {
        const std::size_t start = at_;
        const std::size_t close = text_.find(']', at_);
        if (close == std::string::npos) {
            return fail("missing ']' after an INI section name", place_of(line_, start, file_));
        }
        const std::string section = text_.substr(at_ + 1, close - at_ - 1);
        at_ = close + 1;
        const Result<std::string> name = read_name(start);
        if (!name) {
            return std::unexpected(name.error());
        }
        const SourcePlace place = place_of(line_, start, file_);
        if (variables_.ini == nullptr) {
            return fail(fmt::format("'[{}]{}' needs an INI file, and none was given", section, *name), place,
                        "name it with -i FILE");
        }
        const std::optional<std::string> value = variables_.ini->find(section, *name);
        if (!value) {
            const std::string near = nearest_name(*name, variables_.ini->names(section));
            return fail(fmt::format("INI entry '[{}]{}' not found", section, *name), place,
                        near.empty() ? "" : fmt::format("did you mean '[{}]{}'?", section, near));
        }
        out_.append(*value, line_.at(start));
        return {};
    }

    const PlacedText &line_;
    const std::string &text_;
    const std::string &file_;
    const Variables &variables_;
    PlacedText out_;
    std::size_t at_ = 0;
};

}  // namespace

void PlacedText::append(char c, Position position) {
    text_.push_back(c);
    positions_.push_back(position);
}

void PlacedText::append(std::string_view text, Position position) {
    text_.append(text);
    positions_.insert(positions_.end(), text.size(), position);
}

void PlacedText::truncate(std::size_t size) {
    text_.resize(size);
    positions_.resize(size);
}

PlacedText::Position PlacedText::at(std::size_t i) const {
    if (i < positions_.size()) {
        return positions_[i];
    }
    if (positions_.empty()) {
        return {};
    }
    Position last = positions_.back();
    ++last.column;
    return last;
}

std::vector<LogicalLine> split_lines(std::string_view source, int first_line) {
    std::vector<LogicalLine> lines;
    LogicalLine current;
    int line = first_line;
    int column = 1;
    const auto finish = [&] {
        current.text.truncate(comment_start(current.text.text()));
        if (current.text.text().find_first_not_of(BLANKS) != std::string::npos) {
            lines.push_back(std::move(current));
        }
        current = LogicalLine{};
    };
    for (std::size_t i = 0; i < source.size(); ++i) {
        const char c = source[i];
        if (current.first_line == 0) {
            current.first_line = line;
        }
        const bool is_line_break = c == '\r' && i + 1 < source.size() && source[i + 1] == '\n';
        if (is_line_break) {
            continue;
        }
        if (c == '\n') {
            const std::string &text = current.text.text();
            if (!text.empty() && text.back() == '\\') {
                current.text.truncate(text.size() - 1);
            } else {
                finish();
            }
            ++line;
            column = 1;
            continue;
        }
        current.text.append(c, {line, column});
        ++column;
    }
    if (!current.text.text().empty() && current.text.text().back() == '\\') {
        current.text.truncate(current.text.size() - 1);
    }
    finish();
    return lines;
}

Result<PlacedText> substitute(const PlacedText &line, const std::string &file, const Variables &variables) {
    if (line.text().find_first_of("$[") == std::string::npos) {
        return line;
    }
    return Substituter(line, file, variables).run();
}

Result<std::vector<Word>> split_words(const PlacedText &line, const std::string &file) {
    std::vector<Word> words;
    const std::string &text = line.text();
    std::size_t i = 0;
    while (true) {
        while (i < text.size() && isBlank(text[i])) {
            ++i;
        }
        if (i >= text.size()) {
            return words;
        }
        Word word;
        word.place = place_of(line, i, file);
        while (i < text.size() && !isBlank(text[i])) {
            const char c = text[i];
            if (c != '"' && c != '\'') {
                word.text.push_back(c);
                word.raw.push_back(c);
                ++i;
                continue;
            }
            const std::size_t close = text.find(c, i + 1);
            if (close == std::string::npos) {
                return fail("unterminated quoted string", place_of(line, i, file));
            }
            word.text.append(text, i + 1, close - i - 1);
            word.raw.append(text, i, close - i + 1);
            i = close + 1;
        }
        words.push_back(std::move(word));
    }
}

bool isArrow(std::string_view word) {
    const bool only_arrow_characters =
        word.size() >= 2 && word.find_first_not_of("<=>") == std::string_view::npos;
    return only_arrow_characters && (word.front() == '<' || word.back() == '>');
}

}  // namespace mw::hal::script
