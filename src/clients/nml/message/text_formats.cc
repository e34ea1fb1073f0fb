// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/message/text_formats.hh"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/text.hh"
#include "messages/declarations/text.hh"
#include "messages/declarations/value.hh"

namespace mw::nml {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();
/// Suffix of a list's name for its number of entries.
constexpr std::string_view COUNT = ".count";

std::string path_text(const std::vector<std::string> &path, const Value &value) {
    std::string name;
    for (const std::string &part : path) {
        name += part;
        name += '.';
    }
    name += value.field.name;
    return messages::isSeries(value.field.type) ? fmt::format("{}[{}]", name, value.index) : name;
}

std::string count_name(const std::vector<std::string> &path, const Value &value) {
    std::string name = path_text(path, value);
    name.resize(name.rfind('['));
    return name += COUNT;
}

void enter_path(std::vector<std::string> &path, const Value &value) {
    path.push_back(path_text({}, value));
}

bool isWide(const Value &value) {
    return value.field.type.kind == messages::Kind::UNSIGNED;
}

int hex_digit(char c) {
    constexpr std::string_view DIGITS = "0123456789abcdef";
    const std::size_t at = DIGITS.find(c);
    return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// False if the text is not in the form of messages::quoted().
bool unquote(std::string_view text, std::string &plain) {
    plain.clear();
    if (text.size() < 2 || text.front() != '"' || text.back() != '"') {
        return false;
    }
    text = text.substr(1, text.size() - 2);
    while (!text.empty()) {
        if (text[0] != '\\') {
            plain += text[0];
            text.remove_prefix(1);
        } else if (text.size() >= 2 && (text[1] == '"' || text[1] == '\\')) {
            plain += text[1];
            text.remove_prefix(2);
        } else if (text.size() >= 4 && text[1] == 'x' && hex_digit(text[2]) >= 0 && hex_digit(text[3]) >= 0) {
            plain += static_cast<char>(16 * hex_digit(text[2]) + hex_digit(text[3]));
            text.remove_prefix(4);
        } else {
            return false;
        }
    }
    return true;
}

}  // namespace

void TextWriter::put_line(const std::string &name, std::string_view text) {
    out_ += name;
    out_ += '=';
    out_ += text;
    out_ += '\n';
}

void TextWriter::put(const Value &value, std::string_view text) {
    if (style_ == TextStyle::DISPLAY) {
        put_line(path_text(path_, value), text);
    } else {
        out_ += ',';
        out_ += text;
    }
}

bool TextWriter::head(FrameHead &head) {
    out_ += style_ == TextStyle::ASCII ? fmt::format("{},{}", head.number, head.shape)
                                       : fmt::format("{} {}\n", head.name, head.number);
    return true;
}

bool TextWriter::integer(const Value &value, std::int64_t &number) {
    const char *name = style_ == TextStyle::DISPLAY ? messages::name_of(value.field.type, number) : nullptr;
    put(value, name != nullptr ? std::string(name)
               : isWide(value) ? std::to_string(static_cast<std::uint64_t>(number))
                               : std::to_string(number));
    return true;
}

bool TextWriter::real(const Value &value, double &number) {
    put(value, std::isfinite(number) ? to_text(number)
               : std::isnan(number)  ? "nan"
               : number > 0          ? "inf"
                                     : "-inf");
    return true;
}

bool TextWriter::text(const Value &value, std::string_view &text, std::size_t) {
    put(value, messages::quoted(text));
    return true;
}

bool TextWriter::count(const Value &value, std::uint32_t &count) {
    if (style_ == TextStyle::DISPLAY) {
        put_line(count_name(path_, value), std::to_string(count));
    } else {
        put(value, std::to_string(count));
    }
    return true;
}

void TextWriter::enter(const Value &value) {
    enter_path(path_, value);
}

void TextWriter::leave() {
    path_.pop_back();
}

bool TextWriter::end() {
    if (style_ == TextStyle::ASCII) {
        out_ += '\n';
    }
    return true;
}

bool TextReader::take_value(std::string_view &text) {
    std::size_t end = 0;
    if (!bytes_.empty() && bytes_[0] == '"') {
        for (end = 1; end < bytes_.size() && bytes_[end] != '"'; ++end) {
            end += bytes_[end] == '\\' ? 1 : 0;
        }
        ++end;
    }
    end = bytes_.find_first_of(style_ == TextStyle::ASCII ? ",\n" : "\n", std::min(end, bytes_.size()));
    if (end == std::string_view::npos) {
        return refuse("the message ends within it");
    }
    text = bytes_.substr(0, end);
    bytes_.remove_prefix(end);
    return true;
}

bool TextReader::take_name(const std::string &name) {
    if (!bytes_.starts_with(name) || bytes_.size() <= name.size() || bytes_[name.size()] != '=') {
        return refuse(fmt::format("'{}=' was expected", name));
    }
    bytes_.remove_prefix(name.size() + 1);
    return true;
}

bool TextReader::take(const Value &value, std::string_view &text) {
    if (style_ == TextStyle::DISPLAY) {
        if (!take_name(path_text(path_, value)) || !take_value(text)) {
            return false;
        }
        bytes_.remove_prefix(1);
        return true;
    }
    if (bytes_.empty() || bytes_[0] != ',') {
        return refuse("the message ends before it");
    }
    bytes_.remove_prefix(1);
    return take_value(text);
}

bool TextReader::head(FrameHead &head) {
    const std::size_t line = bytes_.find('\n');
    if (line == std::string_view::npos) {
        return refuse("the message has no line");
    }
    const bool ascii = style_ == TextStyle::ASCII;
    const std::size_t space = bytes_.substr(0, line).find(ascii ? ',' : ' ');
    if (space == std::string_view::npos) {
        return refuse("the message has no number");
    }
    const std::size_t end = ascii ? std::min(bytes_.find(',', space + 1), line) : line;
    const std::string_view first = bytes_.substr(0, space),
                           second = bytes_.substr(space + 1, end - space - 1);
    const auto number = parse_int(ascii ? first : second);
    const auto shape = ascii ? parse_uint(second) : 0;
    if (!number.has_value() || *number < 0 || *number > std::numeric_limits<int>::max() ||
        !shape.has_value() || *shape > std::numeric_limits<std::uint32_t>::max()) {
        return refuse("the message does not begin with its number");
    }
    head.number = static_cast<int>(*number);
    head.shape = static_cast<std::uint32_t>(*shape);
    head.name = ascii ? "" : first;
    bytes_.remove_prefix(ascii ? end : end + 1);
    return true;
}

bool TextReader::integer(const Value &value, std::int64_t &number) {
    std::string_view text;
    if (!take(value, text)) {
        return false;
    }
    for (const messages::Name &name : value.field.type.names) {
        if (style_ == TextStyle::DISPLAY && text == name.name) {
            number = name.value;
            return true;
        }
    }
    if (isWide(value)) {
        const auto read = parse_uint(text);
        const bool fitting = read.has_value() && (value.field.type.bytes == 8 || *read <= 0xffffffffU);
        number = static_cast<std::int64_t>(read.value_or(0));
        return fitting || refuse("it is no whole number of its type");
    }
    const auto read = parse_int(text);
    number = read.value_or(0);
    return read.has_value() || refuse("it is no whole number");
}

bool TextReader::real(const Value &value, double &number) {
    std::string_view text;
    if (!take(value, text)) {
        return false;
    }
    if (text == "inf" || text == "-inf" || text == "nan") {
        number = text == "inf"   ? INFINITE
                 : text == "nan" ? std::numeric_limits<double>::quiet_NaN()
                                 : -INFINITE;
        return true;
    }
    const auto read = parse_double(text);
    number = read.value_or(0);
    return read.has_value() || refuse("it is no number");
}

bool TextReader::text(const Value &value, std::string_view &text, std::size_t longest) {
    std::string_view quoted_text;
    if (!take(value, quoted_text)) {
        return false;
    }
    if (!unquote(quoted_text, plain_)) {
        return refuse("it is no text in quotes");
    }
    text = plain_;
    return plain_.size() <= longest ||
           refuse(fmt::format("{} bytes are longer than it may be", plain_.size()));
}

bool TextReader::count(const Value &value, std::uint32_t &count) {
    std::string_view text;
    if (style_ == TextStyle::DISPLAY) {
        if (!take_name(count_name(path_, value)) || !take_value(text)) {
            return false;
        }
        bytes_.remove_prefix(1);
    } else if (!take(value, text)) {
        return false;
    }
    const auto read = parse_uint(text);
    if (!read.has_value() || *read > bytes_.size()) {  // each entry has at least one byte
        return refuse("the message ends within it");
    }
    count = static_cast<std::uint32_t>(*read);
    return true;
}

void TextReader::enter(const Value &value) {
    enter_path(path_, value);
}

void TextReader::leave() {
    path_.pop_back();
}

bool TextReader::end() {
    const bool at_end = style_ == TextStyle::ASCII ? bytes_ == "\n" : bytes_.empty();
    return at_end || refuse(fmt::format("{} bytes too many", bytes_.size()));
}

}  // namespace mw::nml
