// SPDX-License-Identifier: GPL-2.0-or-later
// Messages as JSON: {"message":"JogStop","is_joint":true,"index":0}. Enumerations by name, infinite numbers
// as the texts "inf" and "-inf", NaN as "nan".
#pragma once

#include <string>

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

std::string to_json(const ConstObject &message);
/// A single value of a message; for an array one element.
std::string to_json(const Field &field, const void *at);

/// The value of "message", which selects the declaration.
Result<std::string> json_name(std::string_view json);

/// Reads one message of this declaration. Unknown fields and missing ones without a default are errors.
Result<> from_json(std::string_view json, const Object &message);

}  // namespace mw::messages
