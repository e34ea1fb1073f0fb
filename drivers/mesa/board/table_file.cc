// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/table_file.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::mesa::board {

Result<TableLine> TableLine::parse(std::string_view text, const SourcePlace &place) {
    TableLine line;
    line.place_ = place;
    std::size_t at = 0;
    while (true) {
        at = text.find_first_not_of(" \t\r", at);
        if (at == std::string_view::npos || text[at] == '#') {
            break;
        }
        const std::size_t end = std::min(text.find_first_of(" \t\r#", at), text.size());
        const std::string word(text.substr(at, end - at));
        const SourcePlace here{place.file, place.line, static_cast<int>(at) + 1};
        const std::size_t equals = word.find('=');
        if (line.type_.empty()) {
            line.type_ = word;
            line.place_ = here;
        } else if (equals != std::string::npos) {
            line.values_.push_back({word.substr(0, equals), word.substr(equals + 1), here});
        } else if (line.name_.empty() && line.values_.empty()) {
            line.name_ = word;
        } else {
            return fail(fmt::format("Unexpected word '{}', expected KEY=VALUE.", word), here);
        }
        at = end;
    }
    return line;
}

TableValue *TableLine::find(std::string_view key) {
    const auto one = std::ranges::find(values_, key, &TableValue::key);
    return one == values_.end() ? nullptr : &*one;
}

bool TableLine::has(std::string_view key) const {
    return std::ranges::find(values_, key, &TableValue::key) != values_.end();
}

TableValue *TableLine::required(std::string_view key, bool optional) {
    TableValue *value = find(key);
    if (value == nullptr && !optional) {
        reject(key, fmt::format("'{}' needs {}=VALUE.", type_, key));
    } else if (value != nullptr) {
        value->used = true;
    }
    return value;
}

void TableLine::reject(std::string_view key, std::string message) {
    if (!error_.has_value()) {
        const TableValue *value = find(key);
        error_ = Error{std::move(message), value == nullptr ? place_ : value->place};
    }
}

std::int64_t TableLine::whole(std::string_view key, std::int64_t low, std::int64_t high,
                              std::optional<std::int64_t> fallback) {
    const TableValue *value = required(key, fallback.has_value());
    if (value == nullptr) {
        return fallback.value_or(low);
    }
    const auto number = parse_int(value->value);
    if (!number.has_value() || *number < low || *number > high) {
        reject(key, fmt::format("{}={} is not a whole number from {} to {}.", key, value->value, low, high));
        return low;
    }
    return *number;
}

double TableLine::number(std::string_view key, double low, double high, std::optional<double> fallback) {
    const TableValue *value = required(key, fallback.has_value());
    if (value == nullptr) {
        return fallback.value_or(low);
    }
    const auto number = parse_double(value->value);
    if (!number.has_value() || *number < low || *number > high) {
        reject(key, fmt::format("{}={} is not a number from {} to {}.", key, value->value, low, high));
        return low;
    }
    return *number;
}

std::string TableLine::text(std::string_view key, std::optional<std::string> fallback) {
    const TableValue *value = required(key, fallback.has_value());
    return value == nullptr ? fallback.value_or("") : value->value;
}

std::size_t TableLine::choice(std::string_view key, const std::vector<std::string> &words,
                              std::optional<std::size_t> fallback) {
    const TableValue *value = required(key, fallback.has_value());
    if (value == nullptr) {
        return fallback.value_or(0);
    }
    const auto one = std::ranges::find(words, value->value);
    if (one == words.end()) {
        reject(key, fmt::format("{}={} is not one of {}.", key, value->value, fmt::join(words, ", ")));
        return 0;
    }
    return static_cast<std::size_t>(one - words.begin());
}

Result<> TableLine::finish() {
    for (const TableValue &value : values_) {
        if (!error_.has_value() && !value.used) {
            error_ = Error{fmt::format("'{}' has no value '{}'.", type_, value.key), value.place};
        }
    }
    if (error_.has_value()) {
        return std::unexpected(*error_);
    }
    return {};
}

Result<std::vector<TableLine>> parse_table(std::string_view text, const std::string &file) {
    std::vector<TableLine> lines;
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        auto line = TableLine::parse(text.substr(0, end), {file, ++number, 0});
        if (!line.has_value()) {
            return std::unexpected(line.error());
        }
        if (!line->type().empty()) {
            lines.push_back(std::move(*line));
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace mw::mesa::board
