// SPDX-License-Identifier: GPL-2.0-or-later
// Converts a value that a caller passes for the object `name` to the object's type. An error names both
// types.
#pragma once

#include <string_view>

#include "base/result.hh"
#include "hal/core/value.hh"

namespace mw::hal::detail {

Result<Value> in_type(Type type, std::string_view name, const Value &value);
Result<Value> in_type(Type type, std::string_view name, std::string_view text);

}  // namespace mw::hal::detail
