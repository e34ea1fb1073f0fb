// SPDX-License-Identifier: GPL-2.0-or-later
// What has to be known of a component's C code before a compiler sees it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace mw::halcompile {

/// Brackets in one another, and signs or operators in a row: what walks through an expression, a C compiler
/// too, needs stack for each.
inline constexpr int MOST_NESTED = 256;

struct CodeFacts {
    struct Use {
        std::string name;
        int line = 0;  ///< from the start of the code, from 0
        int column = 0;
    };
    bool hasFunctionWord = false;  ///< FUNCTION stands somewhere, comments excepted
    bool hasQuotedInclude = false;
    std::set<std::string, std::less<>> words;  ///< all of them, outside comments and strings
    std::optional<Use> deep;                   ///< where MOST_NESTED is exceeded first: what exceeds it
    std::vector<Use> functions;                ///< FUNCTION(name) outside comments, strings and directives
};

CodeFacts look_at_code(std::string_view code);

}  // namespace mw::halcompile
