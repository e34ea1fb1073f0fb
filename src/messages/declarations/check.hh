// SPDX-License-Identifier: GPL-2.0-or-later
// Checks the values of a message against the ranges in its declaration.
#pragma once

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

/// An error names message, field, value and range. A real number must be finite.
Result<> check(const ConstObject &message);

}  // namespace mw::messages
