// SPDX-License-Identifier: GPL-2.0-or-later
// Codes whose meaning a subroutine gives: [RS274NGC]REMAP.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "interp/detail/block_values.hh"

namespace mw::interp::detail {

struct Remap {
    char letter = 'g';
    int number = 0;                              ///< ten times the number for G
    std::string name;                            ///< as written: "M400", "G88.1"
    Code code;                                   ///< its row
    std::string ngc;                             ///< name of the subroutine
    bool isPositional = false;                   ///< argspec begins with @: words become #1, #2, ...
    std::vector<char> required, optional_words;  ///< lower case, in the order of the argspec
    bool needsFeed = false, needsSpeed = false;  ///< ^ and > in the argspec
    std::string error;                           ///< why it cannot run; reported when it is reached
};

/// A block that waits for the subroutine of one of its codes.
struct PendingBlock {
    BlockValues values;
    std::size_t next = 0;  ///< the code to go on with
};

/// Reads one REMAP line, as in "M400 modalgroup=5 argspec=PQ ngc=rm400".
Result<Remap> parse_remap(std::string_view text);

}  // namespace mw::interp::detail
