// SPDX-License-Identifier: GPL-2.0-or-later
// Pieces of C among the declarations of a .comp file.
#pragma once

#include <string>

#include "base/result.hh"
#include "hal/halcompile/scanner.hh"

namespace mw::halcompile {

struct CDeclaration {
    std::string type;  ///< its words, without the stars
    std::string stars;
    std::string name;
    std::string size;  ///< text in [], several joined by "]["; empty: no array
};

/// "unsigned long *name[4]": all words but the last are the type.
Result<CDeclaration> take_c_declaration(Scanner &scanner);

/// The text after the word struct, up to its '}': the whole definition.
Result<std::string> take_struct(Scanner &scanner);
/// The text after the word typedef, up to its ';': the whole definition.
Result<std::string> take_typedef(Scanner &scanner);

}  // namespace mw::halcompile
