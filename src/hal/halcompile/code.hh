// SPDX-License-Identifier: GPL-2.0-or-later
// Analysis of a component's C code before it is compiled.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace mw::halcompile {

/// Maximum nesting of brackets, and of consecutive signs or operators: processing an expression, also in a C
/// compiler, uses stack for each.
inline constexpr int MOST_NESTED = 256;

struct CodeFacts {
    struct Use {
        std::string name;
        int line = 0;  ///< from the start of the code, from 0
        int column = 0;
    };
    bool has_function_word = false;  ///< FUNCTION occurs outside comments
    bool has_quoted_include = false;
    std::set<std::string, std::less<>> words;  ///< all of them, outside comments and strings
    std::optional<Use> deep;                   ///< position and text at which MOST_NESTED is first exceeded
    std::vector<Use> functions;                ///< FUNCTION(name) outside comments, strings and directives
};

CodeFacts look_at_code(std::string_view code);

}  // namespace mw::halcompile
