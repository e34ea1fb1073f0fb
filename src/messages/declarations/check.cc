// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/check.hh"

#include <cmath>

#include <fmt/format.h>

#include "messages/declarations/value.hh"

namespace mw::messages {
namespace {

std::string range_text(const Field &field) {
    const std::string unit = *field.unit == '\0' ? "" : fmt::format(" [{}]", field.unit);
    const Range &range = field.range;
    if (std::isinf(range.min) && std::isinf(range.max)) {
        return "a finite number" + unit;
    }
    if (std::isinf(range.max)) {
        return fmt::format("at least {:g}{}", range.min, unit);
    }
    return fmt::format("{:g} to {:g}{}", range.min, range.max, unit);
}

std::unexpected<Error> refuse(const ConstObject &message, const Field &field, const std::string &value,
                              const std::string &allowed) {
    return fail(
        fmt::format("{}: {} is {}, allowed is {}", message.declaration->name, field.name, value, allowed));
}

bool isWithin(const Range &range, double value) {
    return value >= range.min && value <= range.max;
}

Result<> check_text(const ConstObject &message, const Field &field, std::string_view text) {
    if (text.find('\0') != std::string_view::npos) {
        return refuse(message, field, "a text with a zero byte", "a text without one");
    }
    if (!isSeries(field.type) && !isWithin(field.range, static_cast<double>(text.size()))) {
        return refuse(message, field, fmt::format("{} bytes long", text.size()),
                      range_text(field) + " bytes");
    }
    return {};
}

Result<> check_element(const ConstObject &message, const Field &field, const void *at) {
    switch (field.type.kind) {
    case Kind::BOOL:
    case Kind::NAMED: {
        const std::int64_t value = get_integer(field.type, at);
        return isRepresentable(field.type, value)
                   ? Result<>{}
                   : refuse(message, field, std::to_string(value), "one of its names");
    }
    case Kind::INTEGER:
    case Kind::UNSIGNED: {
        const std::int64_t value = get_integer(field.type, at);
        const bool large = field.type.kind == Kind::UNSIGNED && value < 0;
        const double number =
            large ? static_cast<double>(static_cast<std::uint64_t>(value)) : static_cast<double>(value);
        return isSeries(field.type) || isWithin(field.range, number)
                   ? Result<>{}
                   : refuse(message, field, fmt::format("{:.0f}", number), range_text(field));
    }
    case Kind::REAL: {
        const double value = get_real(at);
        return std::isfinite(value) && isWithin(field.range, value)
                   ? Result<>{}
                   : refuse(message, field, fmt::format("{}", value), range_text(field));
    }
    case Kind::TEXT:
    case Kind::FIXED_TEXT: return check_text(message, field, get_text(field.type, at));
    case Kind::PARTS: return check({field.type.parts, at});
    }
    return {};
}

}  // namespace

Result<> check(const ConstObject &message) {
    for (const Field &field : message.declaration->fields) {
        const void *at = field.at(const_cast<void *>(message.data));
        const std::size_t count = count_elements(field.type, at);
        if (field.type.list != nullptr && !isWithin(field.range, static_cast<double>(count))) {
            return refuse(message, field, fmt::format("{} long", count), range_text(field));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto status = check_element(message, field, element(field.type, at, i));
            if (!status.has_value()) {
                return status;
            }
        }
    }
    return {};
}

}  // namespace mw::messages
