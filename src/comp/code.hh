// SPDX-License-Identifier: GPL-2.0-or-later
// What has to be known of a component's C code before a compiler sees it.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace mw::halcompile {

struct CodeFacts {
    struct Use {
        std::string name;
        int line = 0;  ///< from the start of the code, from 0
        int column = 0;
    };
    bool hasFunctionWord = false;  ///< FUNCTION stands somewhere, comments excepted
    bool hasQuotedInclude = false;
    std::set<std::string, std::less<>> words;  ///< all of them, outside comments and strings
    std::vector<Use> functions;                ///< FUNCTION(name) outside comments, strings and directives
};

CodeFacts look_at_code(std::string_view code);

}  // namespace mw::halcompile
