// SPDX-License-Identifier: GPL-2.0-or-later
// The message EMC_IO_GENERIC (1605): one declaration gives its encodings, its check and its name.
#pragma once

#include "messages/declarations/check.hh"

// clang-format off
// begin of the declaration
namespace mw::messages {

struct EmcIoGeneric {
    int index = 0;
    double value = 0;
};
template <>
inline constexpr auto DECLARED<EmcIoGeneric> =
    declare("EmcIoGeneric", 1605, "sets a generic output",
            field<&EmcIoGeneric::index>("index", "number of the output", unit::NONE, range(0, 15)),
            field<&EmcIoGeneric::value>("value", "of the output"));

}  // namespace mw::messages
// end of the declaration
// clang-format on
