// SPDX-License-Identifier: GPL-2.0-or-later
// The parameter file: one "number value" per line, numbers ascending.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {
namespace {

/// Parameters required in every parameter file: G28, G30, G92, and the nine coordinate systems.
std::set<int> required_numbers() {
    std::set<int> numbers;
    const auto add = [&](int first, int count) {
        for (int i = 0; i < count; ++i) {
            numbers.insert(first + i);
        }
    };
    add(P_G28, 9);
    add(P_G30, 9);
    add(P_G92_APPLIED, 11);
    for (int system = 0; system < 9; ++system) {
        add(P_G5X + 20 * system, 10);
    }
    return numbers;
}

bool isBuiltIn(int number) {
    return isBuiltInNumber(number);
}

struct Row {
    int number = 0;
    double value = 0;
};

Result<Row> parse_row(const std::string &path, int line, std::string_view text) {
    const std::vector<std::string> words = split_words(text);
    const int first_column = static_cast<int>(text.find_first_not_of(" \t") + 1);
    const auto number = parse_int(words[0]);
    if (!number || *number < 1 || *number >= PARAMETER_COUNT) {
        return fail(
            fmt::format("'{}' is not the number of a parameter (1 to {})", words[0], PARAMETER_COUNT - 1),
            {path, line, first_column});
    }
    if (words.size() < 2) {
        return fail(fmt::format("parameter {} has no value", *number), {path, line, first_column});
    }
    const int value_column = static_cast<int>(text.find(words[1], words[0].size() + first_column - 1)) + 1;
    const auto value = parse_double(words[1]);
    if (!value) {
        return fail(fmt::format("'{}' is not a number", words[1]), {path, line, value_column});
    }
    if (words.size() > 2) {
        return fail(fmt::format("unexpected '{}' after the value", words[2]), {path, line, value_column});
    }
    return Row{static_cast<int>(*number), *value};
}

}  // namespace

Result<> Parameters::load(const std::string &path) {
    const Result<std::string> text = read_file(path);
    return text ? parse(*text, path) : std::unexpected(text.error());
}

Result<> Parameters::parse(std::string_view text, const std::string &path) {
    std::vector<Row> rows;
    int line = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view content = text.substr(begin, end - begin);
        begin = end + 1;
        ++line;
        if (trim(content).empty()) {
            continue;
        }
        const Result<Row> row = parse_row(path, line, content);
        if (!row) {
            return std::unexpected(row.error());
        }
        rows.push_back(*row);
    }
    for (const Row &row : rows) {
        values_[static_cast<std::size_t>(row.number)] = row.value;
        file_numbers_.push_back(row.number);
    }
    const double system = values_[P_COORDINATE_SYSTEM];
    if (!(system >= 1 && system <= 9)) {
        values_[P_COORDINATE_SYSTEM] = 1;
    }
    return {};
}

std::string Parameters::text() const {
    std::set<int> numbers = required_numbers();
    numbers.insert(file_numbers_.begin(), file_numbers_.end());
    std::string out;
    for (const int number : numbers) {
        if (!isBuiltIn(number)) {
            out += fmt::format("{}\t{:.6f}\n", number, get(number));
        }
    }
    return out;
}

Result<> Parameters::save(const std::string &path) const {
    return write_file_with_backup(path, text());
}

}  // namespace mw::gcode::detail
