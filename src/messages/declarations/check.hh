// SPDX-License-Identifier: GPL-2.0-or-later
// Are the values of a message within the ranges that it declares?
#pragma once

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

/// The error names message, field, value and range. A real number must be a finite one.
Result<> check(const ConstObject &message);

}  // namespace mw::messages
