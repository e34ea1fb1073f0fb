// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/typed_values.hh"

#include <cerrno>

#include "hal/core/detail/names.hh"

namespace mw::hal::detail {

Result<Value> in_type(Type type, std::string_view name, const Value &value) {
    if (value.type != type) {
        return refuse(
            EINVAL, fmt::format("'{}' is of type {}, not {}", name, type_name(type), type_name(value.type)));
    }
    return value;
}

Result<Value> in_type(Type type, std::string_view name, std::string_view text) {
    auto value = parse_value(type, text);
    if (!value) {
        return refuse(EINVAL, fmt::format("'{}': {}", name, value.error().message));
    }
    return value;
}

}  // namespace mw::hal::detail
