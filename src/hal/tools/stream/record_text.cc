// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/stream/record_text.hh"

#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::hal::stream_tools {

namespace {

std::string format_value(hal_type_t type, const hal_stream_data_u &value) {
    switch (type) {
    case HAL_BIT: return value.b ? "1" : "0";
    case HAL_FLOAT: return fmt::format("{:f}", value.f);
    case HAL_S32: return fmt::format("{}", value.s);
    case HAL_U32: return fmt::format("{}", value.u);
    case HAL_S64: return fmt::format("{}", value.l);
    default: return fmt::format("{}", value.k);
    }
}

const char *expected(hal_type_t type) {
    switch (type) {
    case HAL_BIT: return "0 or 1";
    case HAL_FLOAT: return "a number";
    case HAL_S32:
    case HAL_S64: return "an integer";
    default: return "an integer of at least 0";
    }
}

template <class T>
bool fits(std::int64_t value) {
    return value >= std::numeric_limits<T>::min() && value <= std::numeric_limits<T>::max();
}

bool parse_value(hal_type_t type, std::string_view text, hal_stream_data_u &value) {
    if (type == HAL_BIT) {
        value.b = text == "1";
        return text == "0" || text == "1";
    }
    if (type == HAL_FLOAT) {
        const std::optional<double> number = parse_c_double(text);
        value.f = number.value_or(0.0);
        return number.has_value();
    }
    if (type == HAL_U64) {
        const std::optional<std::uint64_t> number = parse_uint(text);
        value.k = number.value_or(0);
        return number.has_value();
    }
    const std::optional<std::int64_t> number = parse_int(text);
    if (!number) {
        return false;
    }
    if (type == HAL_S64) {
        value.l = *number;
        return true;
    }
    if (type == HAL_U32) {
        value.u = static_cast<rtapi_u32>(*number);
        return fits<rtapi_u32>(*number);
    }
    value.s = static_cast<rtapi_s32>(*number);
    return fits<rtapi_s32>(*number);
}

}  // namespace

std::string format_record(const std::vector<hal_type_t> &types, const hal_stream_data_u *values) {
    std::string line;
    for (std::size_t i = 0; i < types.size(); ++i) {
        line += format_value(types[i], values[i]);
        line += ' ';
    }
    return line;
}

bool isSkipped(std::string_view line) {
    const std::string_view text = trim(line);
    return text.empty() || text.front() == '#';
}

Result<std::vector<hal_stream_data_u>> parse_record(const std::vector<hal_type_t> &types,
                                                    std::string_view line) {
    const std::vector<std::string> words = split_words(line);
    std::vector<hal_stream_data_u> values(types.size());
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (i >= words.size()) {
            return fail(fmt::format("expected {} fields, found {}", types.size(), words.size()));
        }
        if (!parse_value(types[i], words[i], values[i])) {
            return fail(fmt::format("field {}: '{}' is not {}", i + 1, words[i], expected(types[i])));
        }
    }
    return values;
}

}  // namespace mw::hal::stream_tools
